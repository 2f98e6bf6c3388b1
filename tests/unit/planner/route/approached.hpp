// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/tip_over_base.hpp"
#include "unit/planner/route/routed.hpp"

/// A machine that is to come to the first block of a program.
namespace meridian::test::approach {

using router::cut;
using router::kRounding;

/// A machine that stands at a pose, 50 mm of clearance.
struct Approached : router::Routed {
  explicit Approached(const MachineModel& m, const ToolPose& pose = {{0, 0, 0}, tilted(0.3, 0.4)},
                      int branch = 0)
      : Routed(m) {
    stand_at(pose, branch);
    start = cursor.joints;
  }
  [[nodiscard]] double length() const {
    double sum = 0;
    for (const PathPiece& path : paths()) sum += path.length;
    return sum;
  }

  JointVector start{};
};

}  // namespace meridian::test::approach
