// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_cells.hpp"

/// Where end_at() ends a path.
#include <gtest/gtest.h>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "unit/planner/feed/straight_grid.hpp"

namespace meridian::test::cell_grid_end {
namespace {

TEST(CellGrid, APathWithoutLengthHasNoCells) {
  StraightGrid g;
  FeedSpan nothing = g.next(0);
  ASSERT_FALSE(is_fault(g.grid.push(nothing)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  EXPECT_EQ(g.grid.last(), 0);
  EXPECT_TRUE(g.grid.is_complete());
}

/// A straight span that begins at `x` mm, with the axis at rest.
JointSpan straight(double x, double length) {
  JointSpan span;
  span.band.length = length;
  span.band.c[0] = {x, 1};
  span.band.c[1] = {30};
  span.band.c[2] = {-20};
  span.band.c[3] = {0.3};
  span.band.c[4] = {0.3};
  span.band.c[5] = {1};
  return span;
}

/// Two straight spans of 50 mm and 50 cells each; of the second there are as many as `kept_cells`
/// leave room for.
struct Ended : StraightGrid {
  explicit Ended(int kept_cells = 512, const MachineModel& m = bench_machine())
      : StraightGrid(m, {.cell_s = 0.004, .feed_share = 1, .kept_cells = kept_cells}),
        second(straight(50, 50)) {
    const ToolPose from = pose_on(straight(0, 50).band.c, 0.0);
    grid.begin(solve(model, model.tool_length_mm, from, 0, JointVector{}).q, model.tool_length_mm);
    for (const JointSpan& joint_span : {straight(0, 50), second}) {
      FeedSpan span = make_feed_span(joint_span, model.tool_length_mm);
      span.cells = 50;
      EXPECT_FALSE(is_fault(grid.push(span)));
    }
    fault = grid.finish();
  }
  void expect_end(std::int64_t cells, double x, double h) const {
    EXPECT_FALSE(is_fault(grid.fault()));
    EXPECT_TRUE(grid.is_complete());
    ASSERT_EQ(grid.last(), cells);
    const FeedCell& last = grid[cells - 1];
    EXPECT_EQ(last.span, 1U);
    EXPECT_NEAR(last.x, x, 1e-9);
    EXPECT_NEAR(last.h, h, 1e-9);
  }

  JointSpan second;
  PathFault fault;
};

TEST(CellGrid, EndsAPathInsideOfACellThatIsShortenedForIt) {
  Ended one;
  one.grid.end_at(one.second, 1, 20.6, 0);
  one.expect_end(71, 20, 0.6);
  const double rate = one.grid[5].at[0].d1[0];  // of joint 0 by u, even all along
  EXPECT_NEAR(one.grid.joints()[0] - Ended().grid.joints()[0], rate * (20.6 - 50), 1e-9);
}

TEST(CellGrid, EndsAPathBetweenTwoCellsWithoutASliver) {
  Ended exact, before, after;
  exact.grid.end_at(exact.second, 1, 20, 0);
  exact.expect_end(70, 19, 1);
  before.grid.end_at(before.second, 1, 19.9, 0);
  before.expect_end(70, 19, 0.9);
  after.grid.end_at(after.second, 1, 20.1, 0);
  after.expect_end(70, 19, 1.1);
}

TEST(CellGrid, EndsAPathBehindTheCellsThatStand) {
  Ended one;
  one.grid.end_at(one.second, 1, 20.6, 75);
  one.expect_end(75, 24, 1);
  Ended sliver;
  sliver.grid.end_at(sliver.second, 1, 20.1, 70);
  sliver.expect_end(71, 20, 0.1);
}

TEST(CellGrid, EndsAPathBehindTheCellsThatAreThere) {
  Ended one(64);  // the last cell that is there begins at 13 mm
  ASSERT_EQ(one.grid.last(), 64);
  one.grid.drop_before(10);
  one.grid.end_at(one.second, 1, 14.7, 0);
  one.expect_end(65, 14, 0.7);
  Ended first(64);
  first.grid.drop_before(10);
  first.grid.end_at(first.second, 1, 0.7, 0);
  first.expect_end(51, 0, 0.7);
}

TEST(CellGrid, MakesCellsOfWhatWasPushedBeforeItsEnd) {
  Ended one(64);
  one.grid.end_at(one.second, 1, 40.6, 0);
  EXPECT_FALSE(one.grid.is_complete()) << "there was no room yet";
  one.grid.drop_before(60);
  EXPECT_FALSE(is_fault(one.grid.make_cells()));
  one.expect_end(91, 40, 0.6);
  Ended sliver(64);
  sliver.grid.end_at(sliver.second, 1, 40.3, 0);
  sliver.grid.drop_before(60);
  EXPECT_FALSE(is_fault(sliver.grid.make_cells()));
  sliver.expect_end(90, 39, 1.3);
  Ended far(64);
  far.grid.end_at(straight(100, 50), 5, 10, 0);
  far.grid.drop_before(60);
  EXPECT_FALSE(is_fault(far.grid.make_cells()));
  far.expect_end(100, 49, 1);
}

/// No cells of it yet: a path is as long as it takes for spans to become cells.
TEST(CellGrid, MakesAllCellsOfAPathThatEndsBeforeItHasAny) {
  StraightGrid g;
  const ToolPose from = pose_on(straight(0, 50).band.c, 0.0);
  g.grid.begin(solve(g.model, g.model.tool_length_mm, from, 0, {}).q, g.model.tool_length_mm);
  for (const double x : {0.0, 10.0, 20.0}) ASSERT_FALSE(is_fault(g.grid.push(straight(x, 10))));
  ASSERT_EQ(g.grid.last(), 0);
  g.grid.end_at(straight(10, 10), 1, 7, 0);
  EXPECT_FALSE(is_fault(g.grid.fault()));
  EXPECT_TRUE(g.grid.is_complete());
  ASSERT_GE(g.grid.last(), CellGrid::kMin);
  double length = 0;
  for (std::int64_t n = 0; n < g.grid.last(); ++n) length += g.grid[n].h;
  EXPECT_NEAR(length, 17, 1e-9);
  EXPECT_EQ(g.grid[g.grid.last() - 1].span, 1U);
}

/// What was not looked at yet may have a fault of its own, ahead of the one that is known.
TEST(CellGrid, SaysWhatFaultLiesAheadOfItsEnd) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = Ended(64).grid.joints()[0] + 0.3;
  const double beyond = 14 + 0.3 / Ended().grid[5].at[0].d1[0];  // x, on the second span
  StraightGrid g(model);
  const ToolPose from = pose_on(straight(0, 50).band.c, 0.0);
  g.grid.begin(solve(model, model.tool_length_mm, from, 0, {}).q, model.tool_length_mm);
  for (const double x : {0.0, 50.0}) ASSERT_FALSE(is_fault(g.grid.push(straight(x, 50))));
  g.grid.end_at(straight(50, 50), 1, 30, 0);
  EXPECT_EQ(g.grid.fault().kind, PathFault::Kind::kTravel);
  EXPECT_EQ(g.grid.faulty_span(), 1U);
  EXPECT_NEAR(g.grid.faulty_x(), beyond, 1e-4);
  g.grid.end_at(straight(50, 50), 1, 12, 0);
  EXPECT_FALSE(is_fault(g.grid.fault()));
  EXPECT_TRUE(g.grid.is_complete());
  const FeedCell& last = g.grid[g.grid.last() - 1];
  EXPECT_NEAR(last.x + last.h, 12, 1e-9);
}

TEST(CellGrid, EndsAPathACellEarlierWhereItsLastOneWouldLeaveTravel) {
  MachineModel model = bench_machine();
  const double there = Ended(64).grid.joints()[0];  // at 14 mm of the second span
  model.joints[0].limits.travel_max = there + 0.3;
  Ended one(512, model);
  EXPECT_EQ(one.fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(one.grid.faulty_span(), 1U);
  one.grid.end_at(one.second, 1, 14.7, 0);
  one.expect_end(64, 13, 1);
  Ended other(512, model);
  other.grid.end_at(other.second, 1, 14.25, 64);
  other.expect_end(65, 14, 0.25);
}

}  // namespace
}  // namespace meridian::test::cell_grid_end
