// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/drive_axis.hpp"

namespace meridian::hal {

/// How an axis finds its reference in HAL, as it is written after --homing:
///
///     X=hal                    HAL searches: home-request, homed
///     X=index:-5:0:400         to the index pulse with -5 mm/s (a rotary axis: deg/s), which is
///                              called 0 and comes within 400 mm; the last two may be left out
///
/// Axes without an option know where they are. Throws drive::DriveError.
/// Proof: tests/unit/hal/homing_option_test.cpp.
void set_homing(std::vector<drive::Axis>& axes, const std::string& option);

}  // namespace meridian::hal
