// SPDX-License-Identifier: Apache-2.0

/// How far the tool is lifted off where joints bend, and where the tip box is near or wide.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "unit/planner/route/approached.hpp"

namespace meridian::test::approach_lift {
namespace {

using approach::Approached;
using approach::cut;
using approach::kRounding;

constexpr double kClearance_mm = 50;

MachineModel robot() {
  MachineModel model = robot_machine(true);
  for (JointSpec& joint : model.joints) {
    joint.limits = bench_machine().joints[3].limits;
    joint.limits.travel_min = -std::numbers::pi;
    joint.limits.travel_max = std::numbers::pi;
  }
  model.clearance_mm = kClearance_mm;
  return model;
}

/// A tool that stands on the part, and lifts off.
struct Lifted : Approached {
  Lifted(const MachineModel& m, const ToolPose& pose) : Approached(m, pose) {
    fault = router.retract(cut(pose.tip, pose.axis), cursor, *staged);
    lift_mm = (cursor.pose.tip - pose.tip).dot(pose.axis);
  }
  PathFault fault;
  double lift_mm = 0;
};

TEST(ApproachLift, OfARobotEndsASixteenthAtMostBeforeAJointIsOutsideTravel) {
  const ToolPose pose{{30, 20, 0}, tilted(0.3, 0.4)};
  const Lifted free(robot(), pose);
  ASSERT_FALSE(is_fault(free.fault));
  ASSERT_NEAR(free.lift_mm, kClearance_mm, kRounding);
  for (const double share : {0.6, 0.97}) {
    MachineModel higher = robot();
    higher.clearance_mm = share * kClearance_mm;
    const JointVector at_share = Lifted(higher, pose).cursor.joints;
    int bound = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t b = static_cast<std::size_t>(bound);
      const double by = std::abs(free.cursor.joints[i] - free.start[i]);
      if (by > std::abs(free.cursor.joints[b] - free.start[b])) bound = static_cast<int>(i);
    }
    const std::size_t b = static_cast<std::size_t>(bound);
    MachineModel narrow = robot();
    JointLimits& limits = narrow.joints[b].limits;
    const bool is_up = free.cursor.joints[b] > free.start[b];
    (is_up ? limits.travel_max : limits.travel_min) = at_share[b];
    const Lifted one(narrow, pose);
    EXPECT_FALSE(is_fault(one.fault));
    EXPECT_NEAR(one.lift_mm, std::floor(16 * share) / 16 * kClearance_mm, kRounding);
  }
}

TEST(ApproachLift, IsWholeWhereTheTipBoxIsWide) {
  MachineModel model = lai_machine();
  model.clearance_mm = kClearance_mm;
  model.tip_box = {true, {-1000, -1000, -1000}, {1000, 1000, 1000}};
  for (const double azimuth : {0.5, 2.1, 3.7, 5.2}) {
    const Lifted one(model, {{0, 0, 0}, tilted(0.01, azimuth)});
    EXPECT_FALSE(is_fault(one.fault));
    EXPECT_NEAR(one.lift_mm, kClearance_mm, kRounding) << "sideways by half a millimetre";
  }
}

}  // namespace
}  // namespace meridian::test::approach_lift
