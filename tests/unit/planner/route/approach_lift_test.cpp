// SPDX-License-Identifier: Apache-2.0

/// How far the tool is lifted off where joints bend, and where the tip box is near or wide.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

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

/// Where a tool of `model` is that stands with the bend at `bend`.
ToolPose pose_with_bend(const MachineModel& model, double bend, double elbow) {
  JointVector q{};
  q[robot::kShoulder] = 1.2;
  q[robot::kElbow] = elbow;
  q[robot::kRoll] = 0.4;
  q[robot::kBend] = bend;
  return forward(model, model.tool_length_mm, q);
}

TEST(ApproachLift, OfARobotBesideASingularPlaceIsInPartsTheShortestNextToIt) {
  const MachineModel model = robot();
  const auto parts_of = [&](double bend, double elbow = -1.9) {
    const Lifted one(model, pose_with_bend(model, bend, elbow));
    EXPECT_FALSE(is_fault(one.fault));
    EXPECT_NEAR(one.lift_mm, kClearance_mm, kRounding);
    std::vector<double> parts;
    for (const PathPiece& path : one.paths()) parts.push_back(path.length / kClearance_mm);
    return parts;
  };
  const auto expect_same = [](const std::vector<double>& got, const std::vector<double>& wanted) {
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t n = 0; n < got.size(); ++n) EXPECT_NEAR(got[n], wanted[n], 1e-9);
  };
  // Nearer than 0.35 rad counts as beside it, and the lift turns the bend by some hundredths.
  expect_same(parts_of(0.6), {1});
  expect_same(parts_of(0.345), {1.0 / 64, 3.0 / 64, 3.0 / 16, 3.0 / 4});
  expect_same(parts_of(0.36, -2.4), {3.0 / 4, 3.0 / 16, 3.0 / 64, 1.0 / 64});
}

/// The wrist goes by the base axis at 8 mm, and the yaw turns by more than a quarter of a turn:
/// nearer to where it began is the branch that has the arm over its back.
TEST(ApproachLift, OfARobotStaysOnItsBranchWhereItGoesByTheBaseAxis) {
  MachineModel model = robot();
  const Vector3 axis(-std::sin(0.9), 0, std::cos(0.9)), wrist(15, 8, 1150);
  const double tool_mm = model.tool_length_mm + 40;
  const ToolPose pose{wrist - tool_mm * axis - Vector3(850, 0, 250), axis};
  const Lifted free(model, pose);
  ASSERT_FALSE(is_fault(free.fault));
  EXPECT_NEAR(free.lift_mm, kClearance_mm, kRounding);
  const double turn = free.cursor.joints[robot::kYaw] - free.start[robot::kYaw];
  ASSERT_GT(std::abs(turn), 2);
  model.joints[robot::kYaw].limits.travel_max =
      std::max(free.start[robot::kYaw], free.start[robot::kYaw] + 0.5 * turn);
  model.joints[robot::kYaw].limits.travel_min =
      std::min(free.start[robot::kYaw], free.start[robot::kYaw] + 0.5 * turn);
  const Lifted narrow(model, pose);
  EXPECT_FALSE(is_fault(narrow.fault));
  EXPECT_GT(narrow.lift_mm, 0);
  EXPECT_LT(narrow.lift_mm, 0.7 * kClearance_mm);
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
