// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// The options of `meridian ctl move`.
struct MoveOptions {
  std::string tip;             ///< x,y,z[,i,j,k] in the work frame in force, mm
  std::string joints;          ///< NAME=VALUE[,...] in mm and deg; the others stay
  std::string position;        ///< `home`, or a position of the machine file
  std::optional<double> feed;  ///< mm/min
};

/// The options of `ctl move` at `command`, which are returned.
std::vector<const CLI::Option*> add_move_options(CLI::App& command, MoveOptions& options);

/// The pose of `text`, x,y,z[,i,j,k]; without an axis it has that of `now`. Nothing where the text
/// is none. Proof: tests/unit/cli/move_options_test.cpp.
[[nodiscard]] std::optional<ToolPose> pose_of(const std::string& text, const ToolPose& now);

/// The joints of `text`, NAME=VALUE[,...] in mm and deg; those that it does not name stay as they
/// are `now`. What is wrong, in words, where it names none of `model`. Proof: as pose_of().
[[nodiscard]] Expected<JointVector, std::string> joints_of(const std::string& text,
                                                           const MachineModel& model,
                                                           const JointVector& now);

/// Prints `what` and the pose behind it, a line.
void print_pose(const char* what, const ToolPose& pose);

/// Moves the machine that publishes `machine`, tip or joints, straight to where the options say,
/// and stays until it is there or the user interrupts, which aborts the move. The exit code.
[[nodiscard]] int run_move(const MoveOptions& options, const dds::MachineInfo& machine,
                           dds::Participant& participant, stream::OperatorLink& link,
                           const std::string& operator_name, const PeerOptions& peer);

}  // namespace meridian::cli
