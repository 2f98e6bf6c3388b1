// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/core/planner/pole_zone.hpp"

namespace meridian {

/// Whether the exact way on `branch` keeps every joint and drive inside travel from `begin`, where
/// windings are near `joints`, on: to PolePlace::known_end, or to where the path behind the reach
/// comes close to the pole again, where another zone decides. Steps of at most 0.5 mm, so short
/// that no turn of the free joint is missed. Units: mm, rad. No memory. Context: planner thread.
[[nodiscard]] bool keeps_travel(const PoleTask& task, const PolePlace& place, double begin,
                                const JointVector& joints, int branch) noexcept;

}  // namespace meridian
