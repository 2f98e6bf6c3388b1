// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/work_frame.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// What `meridian ctl frame set` takes beside its number.
struct FrameOptions {
  std::string at;    ///< x,y,z[,a,b,c] in mm and deg
  std::string name;  ///< at most kFrameNameChars bytes
};

/// The order of `words` (set, select or clear, and a number); or prints what is wrong.
[[nodiscard]] std::optional<FrameOrder> frame_order(const std::vector<std::string>& words,
                                                    const FrameOptions& options);

/// The set-up that the machine publishes, a line for each frame, * before the one in force.
/// Proof: tests/unit/cli/frame_options_test.cpp.
[[nodiscard]] std::string frames_text(const dds::MachineInfo& machine);

}  // namespace meridian::cli
