// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/kinematics/joints.hpp"

namespace meridian::record {

/// What joints, and drives in their order, are drawn in: the same in every picture.
inline constexpr std::array<const char*, kMaxJoints> kJointColours{"#1f5fa8", "#2a9d5c", "#e08214",
                                                                   "#c22f4f", "#7b4fa3", "#444444"};

}  // namespace meridian::record
