// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "service/cli/options/operator/tool_options.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// The options of `meridian ctl probe`.
struct ProbingOptions {
  std::string toward;          ///< -x, +x, -y, ... of the work frame in force
  double distance_mm = 0;      ///< no farther
  std::optional<double> feed;  ///< mm/min
  std::string touches;         ///< file to which the touch is added; empty: none
  std::optional<double>
      retract_mm;  ///< back from the contact; nothing: the tip stays where it rests
};

/// The unit vector in the work frame that `word` names, -x, +x, -y, ...; nothing where it is none.
[[nodiscard]] std::optional<Vector3> axis_of_work_frame(const std::string& word);

/// What a contact says. Units: mm. Frame: the work frame in force.
struct ContactReport {
  Vector3 tip = Vector3::Zero();  ///< feedback in the report of the contact
  double uncertainty_mm = 0;  ///< how far it went since the report before: the contact lies between
  double overtravel_mm = 0;   ///< from there to rest
};

/// The contact that `status`, of a machine at rest, has. Proof:
/// tests/unit/cli/probing_options_test.cpp.
[[nodiscard]] ContactReport contact_of(const dds::Status& status, const MachineModel& model);

/// Moves the tip of the machine that publishes `machine` straight until its probe has contact, and
/// prints what came of it. Returns the exit code: kVerdictNo without contact.
[[nodiscard]] int run_probing(const ProbingOptions& options, const ToolOptions& tool,
                              const dds::MachineInfo& machine, dds::Participant& participant,
                              stream::OperatorLink& link, const std::string& operator_name,
                              const PeerOptions& peer);

}  // namespace meridian::cli
