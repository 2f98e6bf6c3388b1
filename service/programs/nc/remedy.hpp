// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian::nc {

/// What helps where only the control knows what a word does, or what a name stands for.
inline constexpr const char* kMovesByCam = "let the CAM system write the moves themselves";
inline constexpr const char* kNumbersByCam = "let the CAM system write numbers";

inline constexpr const char* kRightMachine =
    "--machine with the file of the machine that the program is written for";

}  // namespace meridian::nc
