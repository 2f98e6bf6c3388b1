// SPDX-License-Identifier: Apache-2.0

/// Which solutions a router finds for a rewind, and in which order.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/kinematics/winding.hpp"
#include "support/keep_out_machine.hpp"
#include "support/machines.hpp"
#include "unit/planner/route/approached.hpp"

namespace meridian::test::rewind_find {
namespace {

using approach::Approached;
using approach::cut;

/// A look ahead that answers what a test says, and remembers what it was asked.
struct Answers : PoleLookAhead {
  void ask(const Start& start, std::span<const RouteAhead> routes) noexcept override {
    asked = start;
    asked_routes.assign(routes.begin(), routes.end());
    found = asked_routes;
    for (std::size_t n = 0; n < found.size(); ++n) {
      found[n].carries = found[n].free < carries_below ? 9 : 4;
      found[n].time_s = 100;
    }
  }
  [[nodiscard]] bool look() noexcept override { return is_known; }
  [[nodiscard]] std::span<const RouteAhead> routes() const noexcept override { return found; }
  [[nodiscard]] bool is_cut_short() const noexcept override { return is_short; }
  Start asked;
  std::vector<RouteAhead> asked_routes, found;
  bool is_known = true, is_short = false;
  double carries_below = -1e9;
};

struct Found {
  explicit Found(const MachineModel& m, int branch = 0)
      : one(m, {{0, 0, 0}, tilted(0.3, 0.4)}, branch) {
    one.router.ask(&answers);
  }
  std::vector<RewindSolution> find(const ClBlock& block = cut({5, 0, 0}, tilted(0.3, 0.5))) {
    RewindSolutions found = one.router.find_rewinds(block, cause, one.cursor);
    return {found.all().begin(), found.all().end()};
  }
  /// Joints of all branches and windings inside travel but the one that the machine stands on.
  [[nodiscard]] std::vector<JointVector> expected() const {
    std::vector<JointVector> out;
    for (int branch = 0; branch < 2; ++branch) {
      const JointVector q =
          solve(one.model, one.cursor.tool_length_mm, one.cursor.pose, branch, one.start).q;
      for (int turns = -6; turns <= 6; ++turns) {
        JointVector turned = q;
        turned[3] += turns * kTurn_rad;
        const bool is_here = std::abs(turned[3] - one.start[3]) < 1e-6;
        if (!is_here && first_joint_outside_travel(one.model, turned, 0) < 0) out.push_back(turned);
      }
    }
    return out;
  }

  Approached one;
  Answers answers;
  Router::RewindCause cause;
};

TEST(Rewinds, AreAllBranchesAndWindingsInsideTravelButTheOneInForce) {
  for (const int branch : {0, 1}) {
    Found with(lai_machine(), branch);
    const auto found = with.find();
    const auto expected = with.expected();
    ASSERT_GT(expected.size(), 5U);
    EXPECT_EQ(found.size(), expected.size());
    for (const JointVector& q : expected) {
      const auto same = std::find_if(found.begin(), found.end(), [&](const RewindSolution& s) {
        return std::abs(s.target.joints[3] - q[3]) < 1e-9 &&
               std::abs(s.target.joints[4] - q[4]) < 1e-9;
      });
      EXPECT_NE(same, found.end()) << q[3];
    }
    int others = 0;
    for (const RewindSolution& s : found) {
      const ToolPose at = forward(with.one.model, with.one.cursor.tool_length_mm, s.target.joints);
      EXPECT_NEAR((at.tip - with.one.cursor.pose.tip).norm(), 0, 1e-9);
      others += s.target.is_other_branch();
      if (!s.target.is_other_branch()) {
        EXPECT_NE(s.target.turns, 0);
        EXPECT_NEAR(s.target.joints[3], with.one.start[3] + s.target.turns * kTurn_rad, 1e-9);
        EXPECT_EQ(s.target.branch, branch);
      } else {
        EXPECT_EQ(s.target.branch, 1 - branch);
      }
    }
    EXPECT_GT(others, 1) << "the other branch has windings of its own";
  }
}

TEST(Rewinds, OfAnEndlessJointLeadToTheOtherBranchAlone) {
  Found with(bench_machine());
  const auto found = with.find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].target.is_other_branch());
}

TEST(Rewinds, LeadIntoNothingThatTheMachineKeepsOutOf) {
  Found plain(lai_machine());
  const auto all = plain.find();
  const auto below = std::count_if(all.begin(), all.end(),
                                   [](const RewindSolution& s) { return s.target.joints[3] < 3; });
  ASSERT_LT(below, static_cast<std::ptrdiff_t>(all.size()));
  Found boxed(with_keep_out(lai_machine(), 0b1000, {0, 0, 0, 3}, {0, 0, 0, 100}));
  const auto left = boxed.find();
  EXPECT_EQ(static_cast<std::ptrdiff_t>(left.size()), below);
  for (const RewindSolution& s : left) EXPECT_LT(s.target.joints[3], 3);
  MachineModel model = lai_machine();
  model.tip_box = {true, {5000, 5000, 5000}, {5001, 5001, 5001}};
  Found nowhere(model);
  EXPECT_TRUE(nowhere.find().empty());
}

TEST(Rewinds, TakeTheTimeOfTheTurnAndOfTheBlocksBehind) {
  Found with(lai_machine());
  const double velocity = with.one.model.joints[3].limits.velocity;
  for (const RewindSolution& s : with.find()) {
    double time = 100;
    for (int i = 3; i < 5; ++i) {
      time += std::abs(s.target.joints[i] - with.one.start[i]) / velocity;
    }
    EXPECT_NEAR(s.time_s, time, 1e-9);
  }
}

TEST(Rewinds, AreSortedByHowFarTheyCarryAndThenByTime) {
  Found with(lai_machine());
  with.answers.carries_below = -2;
  const auto found = with.find();
  bool is_short = false;
  for (std::size_t n = 0; n < found.size(); ++n) {
    EXPECT_EQ(found[n].carries, found[n].target.joints[3] < -2 ? 9 : 4);
    if (n == 0) continue;
    EXPECT_LE(found[n].carries, found[n - 1].carries);
    is_short = is_short || found[n].carries < found[n - 1].carries;
    if (found[n].carries == found[n - 1].carries) {
      EXPECT_GE(found[n].time_s, found[n - 1].time_s);
    }
  }
  EXPECT_TRUE(is_short);
}

TEST(Rewinds, AskForTheBlocksFromWhereTheToolIs) {
  Found with(lai_machine());
  const ClBlock line = cut({5, 0, 0}, tilted(0.3, 0.5));
  (void)with.find(line);
  EXPECT_EQ(with.answers.asked.sequence, line.sequence);
  EXPECT_TRUE(with.answers.asked.is_on_path);
  EXPECT_EQ(with.answers.asked.pose.tip, with.one.cursor.pose.tip);
  EXPECT_EQ(with.answers.asked.tool_length_mm, with.one.cursor.tool_length_mm);
  ClBlock arc = line;
  arc.is_arc = true;
  (void)with.find(arc);
  EXPECT_EQ(with.answers.asked.sequence, arc.sequence - 1) << "the whole arc";
  EXPECT_FALSE(with.answers.asked.is_on_path);
  with.cause.is_in_block = true;
  (void)with.find(arc);
  EXPECT_EQ(with.answers.asked.sequence, arc.sequence);
  EXPECT_TRUE(with.answers.asked.is_on_path);
  with.cause.is_in_block = false;
  arc.sequence = 0;
  (void)with.find(arc);
  EXPECT_EQ(with.answers.asked.sequence, 0U);
  EXPECT_TRUE(with.answers.asked.is_on_path) << "there is no block before the first";
}

TEST(Rewinds, SayWhetherTheyWaitForBlocks) {
  Found with(lai_machine());
  with.answers.is_known = false;
  (void)with.find();
  EXPECT_TRUE(with.one.router.needs_ahead());
  with.answers.is_known = true;
  (void)with.find();
  EXPECT_FALSE(with.one.router.needs_ahead());
}

TEST(Rewinds, CountTheRoomThatIsLeftWhereTheBlocksDoNotShowTheEnd) {
  for (const bool is_upwards : {true, false}) {
    Found with(lai_machine());
    const double here = with.one.start[3];
    with.answers.is_short = true;
    with.cause.fault = {PathFault::Kind::kTravel, 3, here + (is_upwards ? 1 : -1)};
    const JointLimits& limits = with.one.model.joints[3].limits;
    const auto found = with.find();
    for (const RewindSolution& s : found) {
      EXPECT_EQ(s.room, room_of(limits, s.target.joints[3], is_upwards));
    }
    EXPECT_EQ(found[0].target.joints[3] < 0, is_upwards);
    with.cause.fault.joint = 4;
    for (const RewindSolution& s : with.find()) EXPECT_EQ(s.room, 0) << "of another joint";
    with.cause.fault.joint = 3;
    with.answers.is_short = false;
    for (const RewindSolution& s : with.find()) EXPECT_EQ(s.room, 0) << "the end is known";
  }
}

TEST(Rewinds, FollowTheBlocksThatTheRouterLooksAtWhereNobodyElseDoes) {
  for (const double sense : {1.0, -1.0}) {
    Found with(lai_machine());
    with.one.router.ask(nullptr);
    std::vector<ClBlock> blocks;
    for (int n = 0; n < 30; ++n) {
      blocks.push_back(cut({0.5 * n, 0, 0}, tilted(0.3, 0.4 + sense * 0.4 * (n + 1))));
      blocks.back().sequence = static_cast<std::uint64_t>(7 + n);
    }
    with.one.router.look_at(blocks, {});
    const auto found = with.find(blocks[0]);
    ASSERT_GT(found.size(), 3U);
    EXPECT_GT(found.front().carries, found.back().carries);
    const auto towards = [&](const JointVector& q) {
      Approached turned(lai_machine(), {{0, 0, 0}, tilted(0.3, 0.4 + sense * 0.4)});
      return std::remainder(turned.start[3] - with.one.start[3], kTurn_rad) > 0 ? q[3] : -q[3];
    };
    EXPECT_LT(towards(found.front().target.joints), towards(found.back().target.joints))
        << "wound back farthest against the turn of the blocks";
    EXPECT_FALSE(with.one.router.needs_ahead());
    for (const RewindSolution& s : found) EXPECT_GT(s.time_s, 0);
  }
}

TEST(Rewinds, ToTheOtherBranchTurnOnThePoleOffThePart) {
  MachineModel model = lai_machine();
  model.rewind_retract_mm = 30;
  Found with(model);
  const auto found = with.find();
  int others = 0;
  for (const RewindSolution& s : found) {
    if (!s.target.is_other_branch()) continue;
    ++others;
    Approached one(model);
    const JointVector from = one.cursor.joints;
    ASSERT_FALSE(is_fault(
        one.router.rewind(cut({0, 0, 0}, tilted(0.3, 0.4)), s.target, one.cursor, *one.staged)));
    one.expect_joined(from);
    const auto paths = one.paths();
    ASSERT_EQ(paths.size(), 5U);
    EXPECT_NEAR((to_vector(paths[0].tip_delta) - 30 * tilted(0.3, 0.4)).norm(), 0, 1e-9);
    EXPECT_NEAR(std::abs(paths[1].joints_end[4]), 0, 1e-9) << "the axis goes to the pole";
    EXPECT_EQ(paths[2].kind, PathKind::kTurn);
    EXPECT_NEAR((to_vector(paths[4].tip_delta) + 30 * tilted(0.3, 0.4)).norm(), 0, 1e-9);
    for (const PathPiece& path : paths) EXPECT_EQ(path.motion, MotionKind::kRewind);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(one.cursor.joints[i], s.target.joints[i], 1e-7) << i;
    EXPECT_EQ(one.cursor.pose.tip, Vector3::Zero());
    EXPECT_EQ(one.router.axis_deviation_rad(), 0) << "nothing of it is on the part";
  }
  EXPECT_GT(others, 1);
}

}  // namespace
}  // namespace meridian::test::rewind_find
