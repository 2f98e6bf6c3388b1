// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/joint_cells.hpp"

/// What is checked of joints between two places of a path.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "unit/planner/feed/straight_grid.hpp"

namespace meridian::test::joint_checks {
namespace {

LimitedVector only(double value, int i = 0) {
  LimitedVector out{};
  out[i] = value;
  return out;
}

TEST(JointChecks, FindTravelThatIsLeftAtATurnBetweenTwoPlaces) {
  MachineModel model = bench_machine();
  // From 1 and back over 2 of path, with slopes 0.5 and -0.5: by 0.25 beyond.
  const LimitedVector a = only(1), da = only(0.5), db = only(-0.5);
  model.joints[0].limits.travel_max = 1.2501;
  EXPECT_FALSE(is_fault(check_turns(model, a, da, a, db, 2)));
  model.joints[0].limits.travel_max = 1.2499;
  const PathFault fault = check_turns(model, a, da, a, db, 2);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 0);
  EXPECT_NEAR(fault.value, 1.25, 1e-12);
  EXPECT_FALSE(is_fault(check_turns(model, a, da, a, da, 2))) << "it does not turn";
  model.joints[0].limits.travel_max = 100;
  model.joints[0].limits.travel_min = 0.7501;
  EXPECT_NEAR(check_turns(model, a, db, a, da, 2).value, 0.75, 1e-12);
  model.joints[0].limits.travel_min = 0.7499;
  EXPECT_FALSE(is_fault(check_turns(model, a, db, a, da, 2)));
  // Over 1 of path from 1 by 0.3, slopes 1 and -0.5: t = 2/3.
  model.joints[0].limits.travel_min = -100;
  model.joints[0].limits.travel_max = 1;
  const double t = 2.0 / 3;
  const double top = 1 + 0.3 * t * t * (3 - 2 * t) + t * (1 - t) * ((1 - t) * 1 + t * 0.5);
  EXPECT_NEAR(check_turns(model, a, only(1), only(1.3), only(-0.5), 1).value, top, 1e-12);
}

TEST(JointChecks, TellAJumpOfARobotFromAStepThatItsDerivativesSay) {
  MachineModel robot = bench_machine();
  robot.family = MachineFamily::kRobot;
  const double h = 0.5;
  const LimitedVector none{};
  // q = 0.2 + x - 2 x² + 3 x³ over h.
  const LimitedVector a = only(0.2, 2), b = only(0.2 + h - 2 * h * h + 3 * h * h * h, 2);
  const LimitedVector a1 = only(1, 2), b1 = only(1 - 4 * h + 9 * h * h, 2);
  const LimitedVector a2 = only(-4, 2), b2 = only(-4 + 18 * h, 2), a3 = only(18, 2);
  EXPECT_FALSE(is_fault(check_joins(robot, {a, a1, a2, a3}, {b, b1, b2, a3}, h)));
  LimitedVector far = b;
  far[2] += 0.5;
  const PathFault fault = check_joins(robot, {a, a1, a2, a3}, {far, b1, b2, a3}, h);
  EXPECT_EQ(fault.kind, PathFault::Kind::kJump);
  EXPECT_EQ(fault.joint, 2);
  EXPECT_NEAR(fault.value, far[2] - a[2], 1e-12);
  EXPECT_FALSE(is_fault(check_joins(bench_machine(), {a, a1, a2, a3}, {far, b1, b2, a3}, h)));
  // What is off may be a hundredth of what the joint bends by, and that is no more than its way.
  LimitedVector off = b;
  const double bend = std::abs(b1[2] - 1) + h * (5 + h * 18);
  const double rate = std::abs(b[2] - 0.2) / h + 1 + std::abs(b1[2]);
  ASSERT_LT(rate, bend);
  off[2] += 0.9 * 0.01 * h * rate;
  EXPECT_FALSE(is_fault(check_joins(robot, {a, a1, a2, a3}, {off, b1, b2, a3}, h)));
  off[2] += 0.3 * 0.01 * h * rate;
  EXPECT_TRUE(is_fault(check_joins(robot, {a, a1, a2, a3}, {off, b1, b2, a3}, h)));
  // A joint that rests may be off by rounding alone.
  const LimitedVector noise = only(0.9e-9), more = only(1.1e-9);
  EXPECT_FALSE(
      is_fault(check_joins(robot, {none, none, none, none}, {noise, none, none, none}, h)));
  EXPECT_TRUE(is_fault(check_joins(robot, {none, none, none, none}, {more, none, none, none}, h)));
}

TEST(JointChecks, SeeHowFarJointsBendOffTheLineIntoAKeepOutBox) {
  MachineModel model = bench_machine();
  KeepOutBox other, box;
  other.joints = 0b100;
  other.min = {0, 0, 50};
  other.max = {0, 0, 51};
  ASSERT_TRUE(model.keep_out.add(other));
  box.joints = 0b11;
  box.min = {-1.5, 0.2};
  box.max = {-0.5, 1};
  ASSERT_TRUE(model.keep_out.add(box));
  const LimitedVector from = only(-1), to = only(1), d1 = only(1), none{};
  // Over h = 2 a second derivative of 0.3 bends by 1.25 · 4/8 · 0.3 = 0.1875.
  const auto bent_by = [&](double d2, double d3, double at = 0) {
    LimitedVector a = from, b = to;
    a[1] = b[1] = at;
    return check_keep_out(model, {a, d1, only(d2, 1), only(d3, 1)}, {b, d1, none, none}, 2);
  };
  EXPECT_FALSE(is_fault(bent_by(0.3, 0)));
  EXPECT_EQ(bent_by(0.33, 0).kind, PathFault::Kind::kKeepOut);
  EXPECT_EQ(bent_by(-0.33, 0).value, 1) << "the second box";
  EXPECT_FALSE(is_fault(bent_by(0, 0.3)));
  EXPECT_TRUE(is_fault(bent_by(0, -0.33))) << "half of the length times the third derivative";
  EXPECT_TRUE(is_fault(bent_by(0, 0, 0.21)));
  EXPECT_TRUE(is_fault(bent_by(std::numeric_limits<double>::infinity(), 0)));
  EXPECT_TRUE(has_boxes(model));
  EXPECT_FALSE(has_boxes(bench_machine()));
}

TEST(JointChecks, SeeATipThatTurnsRoundOutsideOfItsBox) {
  MachineModel model = bench_machine();
  const LimitedVector none{};
  const LimitedVector at = only(0), up = only(1), down = only(-1), bend = only(-1);
  // Slide X from 0 and back over 2 with slopes 1 and -1 and a second derivative of -1: within
  // 1.25 · 4/8 of both ends.
  const auto in_box_to = [&](double face) {
    model.tip_box = {true, {-1e4, -1e4, -1e4}, {face, 1e4, 1e4}};
    return check_boxes(model, 100, {at, up, bend, none}, {at, down, bend, none}, 2);
  };
  ASSERT_TRUE(has_boxes((model.tip_box.is_set = true, model)));
  EXPECT_FALSE(is_fault(in_box_to(0.626)));
  const PathFault fault = in_box_to(0.624);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTipBox);
  EXPECT_EQ(fault.joint, 0);
  EXPECT_NEAR(fault.value, 0, 1e-9);
  model.tip_box.max = {4.5, 1e4, 1e4};
  const LimitedVector there = only(5);
  const PathFault end = check_tip_box(model, 100, {at, up, none, none}, {there, up, none, none}, 5);
  EXPECT_NEAR(end.value, 5, 1e-9) << "the end that is outside";
  const PathFault begin =
      check_tip_box(model, 100, {there, down, none, none}, {at, down, none, none}, 5);
  EXPECT_NEAR(begin.value, 5, 1e-9);
}

/// A ram that the head tilts: C table, X Y, A at the head, and Z on it. With A at 90 deg Z runs
/// along Y.
MachineModel tilting_ram() {
  MachineModel model = bench_machine();
  model.family = MachineFamily::kChain;
  const std::array<ChainJoint, 5> chain{
      ChainJoint{3, true, true, Vector3::UnitZ(), Vector3::Zero()},
      ChainJoint{0, false, false, Vector3::UnitX(), Vector3::Zero()},
      ChainJoint{1, false, false, Vector3::UnitY(), Vector3::Zero()},
      ChainJoint{4, true, false, Vector3::UnitX(), Vector3(0, 0, 500)},
      ChainJoint{2, false, false, Vector3::UnitZ(), Vector3::Zero()}};
  model.chain = *describe_chain(chain, Vector3::UnitZ(), Vector3(0, 0, 300));
  return model;
}

TEST(JointChecks, SlidesThatTurnIntoOnePlaneBetweenTwoPlacesJump) {
  const MachineModel ram = tilting_ram();
  ASSERT_TRUE(ram.chain.slides_align);
  EXPECT_FALSE(trunnion_machine().chain.slides_align);
  const LimitedVector none{};
  LimitedVector a{}, b{};
  a[4] = 1.4;
  b[4] = 1.5;
  b[2] = 300;
  EXPECT_FALSE(is_fault(check_joins(ram, {a, none, none, none}, {b, none, none, none}, 0.1)));
  b[4] = 1.6;
  const PathFault fault = check_joins(ram, {a, none, none, none}, {b, none, none, none}, 0.1);
  EXPECT_EQ(fault.kind, PathFault::Kind::kJump);
  EXPECT_EQ(fault.joint, 2) << "the slide that goes farthest";
}

/// No slide is solved for on a joint move: approaches and rewinds may turn through such a place.
TEST(JointChecks, AJointMoveTurnsThroughAPlaceWhereSlidesAlign) {
  StraightGrid g(tilting_ram());
  JointVector end{};
  end[4] = 2;
  FeedSpan span;
  span.path = make_joint_move({}, end, 0);
  span.length = span.path.length;
  ASSERT_FALSE(is_fault(g.grid.push(span)));
  EXPECT_FALSE(is_fault(g.grid.finish()));
  EXPECT_TRUE(g.grid.is_complete());
}

}  // namespace
}  // namespace meridian::test::joint_checks
