// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_cells.hpp"

/// Where the cells of a path end before its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/joints_at.hpp"
#include "unit/planner/feed/straight_grid.hpp"

namespace meridian::test::cell_grid_fault {
namespace {

TEST(CellGrid, SaysWhereAPathLeavesTravelAndKeepsWhatIsBefore) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = 105.3;
  StraightGrid g(model);
  for (int n = 0; n < 2; ++n) ASSERT_FALSE(is_fault(g.push(50, 50)));
  ASSERT_FALSE(is_fault(g.push(50, 50)));
  const PathFault fault = g.grid.finish();
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 0);
  EXPECT_NEAR(fault.value, 105.375, 1e-9) << "the first sample beyond";
  EXPECT_EQ(g.grid.faulty_span(), 2U);
  EXPECT_NEAR(g.grid.faulty_x(), 5.3, 1e-5) << "closer than the samples";
  EXPECT_EQ(g.grid.last(), 105);
  g.expect_gapless({50, 50, 5});
  EXPECT_EQ(g.push(1, 1).kind, PathFault::Kind::kTravel) << "nothing comes behind a fault";
  EXPECT_EQ(g.grid.finish().kind, PathFault::Kind::kTravel);
  g.grid.begin({}, model.tool_length_mm);
  EXPECT_FALSE(is_fault(g.grid.fault()));
  EXPECT_EQ(g.grid.last(), 0);
}

TEST(CellGrid, FindsTravelThatIsLeftBetweenTwoSamples) {
  MachineModel model = bench_machine();
  StraightGrid g(model);
  // The axis turns from one side to the other: the tilt turns round in the middle of a step.
  const double tilt = 0.4;
  const auto pose = [&](double azimuth) {
    return ToolPose{Vector3(0, 0, -20),
                    Vector3(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                            std::cos(tilt))};
  };
  FeedSpan span;
  span.path = make_line(pose(0.0), pose(1.0));
  span.path.tool_length_mm = model.tool_length_mm;
  span.length = span.path.length;
  span.cells = 41;  // an odd number: the turning point lies on a sample, between none
  const JointVector start = solve(model, model.tool_length_mm, pose(0), 0, JointVector{}).q;
  g.grid.begin(start, model.tool_length_mm);
  ASSERT_FALSE(is_fault(g.grid.push(span)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  // Its least tilt by size, and the two samples nearest to it.
  double smallest = 1e300;
  for (int k = 0; k <= 328; ++k) {
    const auto at = joints_at(model, span.path, span.length * k / 328, start);
    smallest = std::min(smallest, std::abs(at.q[4]));
  }
  EXPECT_LT(smallest, tilt - 0.01);
  const double sign = start[4] > 0 ? 1 : -1;
  (sign > 0 ? model.joints[4].limits.travel_min : model.joints[4].limits.travel_max) =
      sign * (smallest + 1e-8);
  StraightGrid other(model);
  other.grid.begin(start, model.tool_length_mm);
  FeedSpan coarse = span;
  coarse.cells = 40;
  coarse.length = span.length * 40 / 40.5;  // no sample on the turning point
  (void)other.grid.push(coarse);
  const PathFault fault = other.grid.finish();
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 4);
}

TEST(CellGrid, TheMachineHasToStandWhereThePathBegins) {
  for (const double off : {1e-8, -1e-8, 1e-6, -1e-6}) {
    StraightGrid g;
    const ToolPose from{Vector3(0, 30, -20), Vector3(0.3, 0.3, 1).normalized()};
    FeedSpan span;
    span.path = make_line(from, {Vector3(20, 30, -20), from.axis});
    span.path.tool_length_mm = g.model.tool_length_mm;
    span.length = span.path.length;
    span.cells = 40;
    JointVector start = solve(g.model, g.model.tool_length_mm, from, 0, JointVector{}).q;
    start[1] += off;
    g.grid.begin(start, g.model.tool_length_mm);
    (void)g.grid.push(span);
    const PathFault fault = g.grid.finish();
    if (std::abs(off) < 1e-7) {
      EXPECT_FALSE(is_fault(fault)) << "rounding";
    } else {
      EXPECT_EQ(fault.kind, PathFault::Kind::kJump);
      EXPECT_EQ(fault.joint, 1);
      EXPECT_NEAR(fault.value, -off, 1e-9);
      EXPECT_EQ(g.grid.last(), 0);
    }
  }
}

TEST(CellGrid, ARotaryJointThatJumpsToAnotherBranchIsNoPath) {
  // Straight over the pole, 1e-9 rad beside it: C turns by half a turn between two samples.
  StraightGrid g;
  const ToolPose from{Vector3(0, 0, -20), Vector3(-0.2, 1e-9, 1).normalized()};
  const ToolPose to{Vector3(20, 0, -20), Vector3(0.2, 1e-9, 1).normalized()};
  const FeedSpan span = g.begin_line(from, to, 41);
  (void)g.grid.push(span);
  const PathFault fault = g.grid.finish();
  EXPECT_EQ(fault.kind, PathFault::Kind::kJump);
  EXPECT_EQ(fault.joint, 3);
  EXPECT_GT(std::abs(fault.value), 1);
  EXPECT_EQ(g.grid.last(), 20);
}

TEST(CellGrid, NoCellReachesIntoWhatTheMachineKeepsOutOf) {
  for (const bool is_tip : {false, true}) {
    MachineModel model = bench_machine();
    if (is_tip) {
      model.tip_box = {true, {-1000, -1000, -1000}, {20.05, 1000, 1000}};
    } else {
      KeepOutBox wall;  // thinner than a step between two samples
      wall.joints = 0b1;
      wall.min = {20.05};
      wall.max = {20.06};
      ASSERT_TRUE(model.keep_out.add(wall));
    }
    StraightGrid g(model);
    ASSERT_FALSE(is_fault(g.push(60, 60)));
    const PathFault fault = g.grid.finish();
    EXPECT_EQ(fault.kind, is_tip ? PathFault::Kind::kTipBox : PathFault::Kind::kKeepOut);
    EXPECT_EQ(g.grid.last(), 20);
  }
}

}  // namespace
}  // namespace meridian::test::cell_grid_fault
