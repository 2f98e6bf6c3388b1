// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

/// The exact path on a branch behind a zone.
struct RouteAfter {
  bool keeps_travel = false;  ///< every joint and drive
  bool is_to_end = false;     ///< it was followed to PolePass::known_end
  double free = 0;            ///< the redundant joint there
};

/// Follows the exact path on `branch` from `begin`, where windings are near `joints`, to
/// PolePass::known_end, or to where the path behind the reach comes close to the pole again, where
/// another zone decides. Steps of at most 0.5 mm, so short that no turn of the redundant joint is
/// missed. Units: mm, rad. No memory. Context: planner thread.
[[nodiscard]] RouteAfter follow_after(const PoleTask& task, const PolePass& pass, double begin,
                                      const JointVector& joints, int branch) noexcept;

}  // namespace meridian
