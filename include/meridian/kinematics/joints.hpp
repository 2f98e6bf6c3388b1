// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace meridian {

inline constexpr int kMaxJoints = 6;

/// One value per joint in machine order (mm or rad); places beyond the machine's joints are zero.
template <class S>
using Joints = std::array<S, kMaxJoints>;
using JointVector = Joints<double>;

}  // namespace meridian
