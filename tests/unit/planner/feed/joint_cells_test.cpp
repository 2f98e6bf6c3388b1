// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/joint_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "support/machines.hpp"

namespace meridian::test::joint_cells {
namespace {

const ToolPose kFrom{Vector3(0, 30, -20), Vector3(0.3, 0.2, 1).normalized()};
const ToolPose kTo{Vector3(30, -10, 0), Vector3(-0.3, 0.25, 1).normalized()};

/// A path on a machine, and its cells.
struct Cells {
  explicit Cells(const MachineModel& m, const ToolPose& from = kFrom, const ToolPose& to = kTo)
      : model(m), path(make_line(from, to)) {
    path.tool_length_mm = model.tool_length_mm;
    start = end = solve(model, model.tool_length_mm, from, 0, JointVector{}).q;
  }
  PathFault append(double begin, double to, int cells) {
    return table->append(model, path, begin, to, cells, end);
  }
  PathFault append_all(int cells) { return append(0, path.length, cells); }

  MachineModel model;
  PathPiece path;
  JointVector start{}, end{};
  std::unique_ptr<CellTable> table = std::make_unique<CellTable>();
};

TEST(JointCells, BoundTheDerivativesOfEveryJointAndDriveOfTheStage) {
  for (const MachineModel& model : {lai_machine(), hybrid_machine()}) {
    const auto pose = [&](const JointVector& q) { return forward(model, model.tool_length_mm, q); };
    Cells one(model, pose({0, 0, 0, -0.5, 0.3}), pose({30, -10, 10, 0.4, 0.5}));
    ASSERT_FALSE(is_fault(one.append_all(40)));
    ASSERT_EQ(one.table->size(), 40);
    JointVector reference = one.start;
    double begin = 0;
    for (const JointCell& cell : one.table->all()) {
      EXPECT_NEAR(cell.begin, begin, 1e-12);
      begin = cell.end;
      LimitedVector d1{}, d2{}, d3{};
      for (int k = 0; k <= 10; ++k) {
        const double s = cell.begin + (cell.end - cell.begin) * k / 10;
        const auto at = joints_at(model, one.path, Jet<3>::variable(s), reference);
        const Limited<Jet<3>> q = limited_of(model, at.q);
        for (int i = 0; i < limited_count(model); ++i) {
          d1[i] = std::max(d1[i], std::abs(q[i].derivative(1)));
          d2[i] = std::max(d2[i], std::abs(q[i].derivative(2)));
          d3[i] = std::max(d3[i], std::abs(q[i].derivative(3)));
        }
        for (int i = 0; i < 5; ++i) reference[i] = value_of(at.q[i]);
      }
      for (int i = 0; i < limited_count(model); ++i) {
        EXPECT_GE(cell.d1[i], d1[i]) << i;
        EXPECT_GE(cell.d2[i], d2[i]) << i;
        EXPECT_GE(cell.d3[i], d3[i]) << i;
        EXPECT_LE(cell.d1[i], 1.1 * d1[i] + 0.03) << i;
        EXPECT_LE(cell.d2[i], 1.3 * d2[i] + 0.01) << i;
        EXPECT_LE(cell.d3[i], 1.5 * d3[i] + 0.01) << i;
      }
      EXPECT_NEAR(cell.share_rate, 1 / one.path.length, 1e-9) << "of a line it is even";
    }
    EXPECT_EQ(begin, one.path.length);
    const auto there = joints_at(model, one.path, one.path.length, reference);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(one.end[i], there.q[i], 1e-9);
  }
}

TEST(JointCells, OfAQuarterMoreThanTheRangeOfTheirSamples) {
  Cells one(lai_machine());
  ASSERT_FALSE(is_fault(one.append(3, 5, 1)));
  const JointCell& cell = one.table->all()[0];
  double a[3] = {};
  for (int k = 0; k < 3; ++k) {
    a[k] = joints_at(one.model, one.path, Jet<3>::variable(3.0 + k), one.start).q[0].derivative(1);
  }
  const double largest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  const double range = std::max({a[0], a[1], a[2]}) - std::min({a[0], a[1], a[2]});
  EXPECT_NEAR(cell.d1[0], largest + 0.25 * range, 1e-9);
  EXPECT_EQ(cell.begin, 3);
  EXPECT_EQ(cell.end, 5);
}

TEST(JointCells, GoOnFromWhereTheyEndedAndForgetWhatIsTakenBack) {
  Cells one(lai_machine());
  ASSERT_FALSE(is_fault(one.append(0, 10, 5)));
  ASSERT_FALSE(is_fault(one.append(10, 20, 7)));
  EXPECT_EQ(one.table->size(), 12);
  EXPECT_EQ(one.table->range(5, 12).front().begin, 10);
  EXPECT_EQ(one.table->range(5, 12).size(), 7U);
  one.table->go_back(5);
  EXPECT_EQ(one.table->size(), 5);
  one.table->clear();
  EXPECT_EQ(one.table->size(), 0);
}

TEST(JointCells, AreNoMoreThanThereIsRoomFor) {
  Cells one(lai_machine());
  ASSERT_FALSE(is_fault(one.append(0, 10, CellTable::kCapacity - 3)));
  const PathFault fault = one.append(10, 20, 4);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTooLong);
  EXPECT_EQ(fault.joint, -1) << "no joint of all";
  EXPECT_EQ(fault.value, 0);
  EXPECT_FALSE(is_fault(one.append(10, 20, 3)));
}

TEST(JointCells, SayHowMuchSlowerThanItsEasiestPlaceACellLooks) {
  Cells one(bench_machine());
  one.path = make_joint_move({}, {10}, 0);
  one.end = {};
  ASSERT_FALSE(is_fault(one.append_all(4)));
  EXPECT_NEAR(one.table->coarseness(), 1, 1e-12) << "an even path";
  Cells bent(lai_machine());
  ASSERT_FALSE(is_fault(bent.append_all(2)));
  const double coarse = bent.table->coarseness();
  EXPECT_GT(coarse, 1.2);
  ASSERT_FALSE(is_fault((bent.end = bent.start, bent.append_all(64))));
  EXPECT_LT(bent.table->coarseness(), 1 + 0.3 * (coarse - 1));
  EXPECT_GE(bent.table->coarseness(), 1);
}

TEST(JointCells, SayWhichJointLeavesTravelAndWhere) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = 5.2;
  Cells one(model);
  one.path = make_joint_move({}, {10}, 0);
  one.end = {};
  const PathFault fault = one.append_all(10);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 0);
  EXPECT_NEAR(fault.value, 5.5, 1e-9);
  one.end = {6};
  one.path = make_joint_move({6}, {3}, 0);
  EXPECT_EQ(one.append_all(10).kind, PathFault::Kind::kTravel) << "at its begin";
  Cells far(bench_machine(), kFrom, {Vector3(3000, 0, 0), kFrom.axis});
  EXPECT_EQ(far.append_all(10).kind, PathFault::Kind::kTravel);
}

TEST(JointCells, SayThatNoJointsAreThere) {
  MachineModel model = bench_machine();
  Cells one(model, kFrom, {Vector3(0, 30, -20), kFrom.axis});
  one.path.kind = PathKind::kSpline;  // its axis vanishes half way
  one.path.length = 2;
  one.path.spline = {};
  one.path.spline[5] = {std::numeric_limits<double>::quiet_NaN()};
  const PathFault fault = one.append(0, 2, 4);
  EXPECT_EQ(fault.kind, PathFault::Kind::kUnreachable);
  EXPECT_EQ(fault.joint, -1);
  EXPECT_EQ(fault.value, 0);
}

TEST(JointCells, MergeToOneThatBoundsBoth) {
  JointCell a, b;
  a.begin = 1;
  a.end = 2;
  b.begin = 2;
  b.end = 5;
  a.share_rate = 3;
  b.share_rate = 4;
  a.noise_rad = 6;
  b.noise_rad = 5;
  a.d1[0] = b.d2[0] = a.d3[0] = 7;
  b.d1[0] = a.d2[0] = b.d3[0] = 8;
  for (const JointCell& both : {merged(a, b), merged(b, a)}) {
    EXPECT_EQ(both.begin, 1);
    EXPECT_EQ(both.end, 5);
    EXPECT_EQ(both.share_rate, 4);
    EXPECT_EQ(both.noise_rad, 6);
    EXPECT_EQ(both.d1[0], 8);
    EXPECT_EQ(both.d2[0], 8);
    EXPECT_EQ(both.d3[0], 8);
  }
}

TEST(JointCells, KnowHowRoundingOfTheAxisShowsBesideThePole) {
  // Past the pole, 0.001 off it in the middle.
  const ToolPose from{Vector3(0, 0, 0), Vector3(-0.1, 0.001, 1).normalized()};
  const ToolPose to{Vector3(10, 0, 0), Vector3(0.1, 0.001, 1).normalized()};
  Cells one(bench_machine(), from, to);
  ASSERT_FALSE(is_fault(one.append_all(200)));
  for (const JointCell& cell : one.table->all()) {
    double distance = 1e9;
    for (const double s : {cell.begin, 0.5 * (cell.begin + cell.end), cell.end}) {
      distance = std::min(distance, pole_distance(one.model, pose_at(one.path, s).axis));
    }
    EXPECT_NEAR(cell.noise_rad, kAxisNoise / distance, 1e-18 + 1e-6 * kAxisNoise / distance);
  }
  Cells still(bench_machine(), from, {to.tip, from.axis});
  ASSERT_FALSE(is_fault(still.append_all(4)));
  EXPECT_EQ(still.table->all()[0].noise_rad, 0) << "an axis that rests is rounded once";
  one.table->clear();
  one.end = one.start;
  one.path.is_free_driven = true;
  one.path.free_begin = one.path.free_end = one.start[3];
  ASSERT_FALSE(is_fault(one.append(0, 1, 2)));
  EXPECT_EQ(one.table->all()[0].noise_rad, 0) << "a joint that is driven is not solved for";
}

}  // namespace
}  // namespace meridian::test::joint_cells
