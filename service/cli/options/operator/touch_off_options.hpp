// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "service/cli/options/operator/tool_options.hpp"
#include "service/machine/inspect/calibrate/touch_off.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// What `meridian ctl touch-off` takes beside its words.
struct TouchOffOptions {
  std::string touches;           ///< file of the touches
  std::string toward;            ///< -x, +x, -y, ... of the work frame in force
  std::string as;                ///< face, edge, plane, corner, bore
  std::optional<double> height;  ///< of the tip above the frame's origin, mm
  bool is_confirmed = false;
};

/// The options of `ctl touch-off` at `command`, which are returned.
std::vector<const CLI::Option*> add_touch_off_options(CLI::App& command, TouchOffOptions& options);

/// The direction in the frame of the kinematics that `word` names by an axis of `machine`'s
/// workpiece; nothing where it is none.
[[nodiscard]] std::optional<Vector3> direction_of(const std::string& word,
                                                  const MachineModel& machine);

/// Where the machine stands now as a touch: with the tool in the spindle as the machine reports it,
/// or as `tool` says. The error says what is missing.
[[nodiscard]] Expected<inspect::Touch, std::string> touch_of(const dds::Status& status,
                                                             const dds::MachineInfo& machine,
                                                             const ToolOptions& tool,
                                                             const Vector3& toward);

/// Adds `touch` to the file of that name, which is made where there is none; false where it cannot
/// be written.
[[nodiscard]] bool append_touch(const std::string& file, const inspect::Touch& touch);

/// `touch`: adds where the machine stands to a file. `frame N`: shows which frame the touches in
/// it make, and sets it where that is confirmed. `tool N`: the same of a tool's length. Returns the
/// exit code. Proof: tests/unit/cli/touch_off_options_test.cpp.
[[nodiscard]] int run_touch_off(const std::vector<std::string>& words,
                                const TouchOffOptions& options, const ToolOptions& tool,
                                const dds::MachineInfo& machine, stream::OperatorLink& link,
                                std::chrono::milliseconds timeout);

}  // namespace meridian::cli
