// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/route_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/kinematics/winding.hpp"
#include "support/keep_out_machine.hpp"
#include "unit/planner/route/routed.hpp"

namespace meridian::test::route_follower {
namespace {

using router::cut;

constexpr double kStep_rad = 0.4;  // of the azimuth per block

/// Some ways of one branch, from a pose off the pole, and blocks that turn the axis round it.
struct Followed {
  explicit Followed(const MachineModel& m, int b = 0, const LookAheadSlack& s = {})
      : model(m), slack(s), branch(b) {
    joints = solve(model, model.tool_length_mm, start, branch, {}).q;
  }
  void add(double turned) {
    routes.push_back({});
    routes.back().branch = branch;
    routes.back().free = joints[3] + turned;
  }
  /// Follows `count` blocks that turn by kStep_rad each; how many it took.
  int turn(int count, double sense = 1, double dx = 0) {
    RouteFollower follower(model, model.tool_length_mm, slack, branch, start, routes);
    int taken = 0;
    for (; taken < count && !follower.is_over(); ++taken) {
      ClBlock block =
          cut({dx * (taken + 1), 0, 0}, tilted(0.3, 0.4 + sense * kStep_rad * (taken + 1)));
      block.sequence = static_cast<std::uint64_t>(taken + 1);
      block.line = static_cast<std::uint32_t>(taken + 101);
      follower.follow(block);
    }
    return taken;
  }
  /// The joint's own sense: +1 where it grows with the azimuth.
  [[nodiscard]] double sense() const {
    const ToolPose next{{0, 0, 0}, tilted(0.3, 0.5)};
    return solve(model, model.tool_length_mm, next, branch, joints).q[3] > joints[3] ? 1 : -1;
  }

  MachineModel model;
  LookAheadSlack slack;
  int branch;
  ToolPose start{{0, 0, 0}, tilted(0.3, 0.4)};
  JointVector joints{};
  std::vector<RouteAhead> routes;
};

MachineModel machine(RewindPolicy policy = RewindPolicy::kRetract) {
  MachineModel model = lai_machine();
  model.rewind_policy = policy;
  return model;
}

TEST(RouteFollower, CountsTheBlocksThatEveryWayCarries) {
  for (const int branch : {0, 1}) {
    Followed one(machine(), branch);
    for (const double turned : {0.0, 2.0, -3.0}) one.add(turned);
    one.routes.push_back({1 - branch, 0.1});
    const double sense = one.sense();
    (void)one.turn(60, sense);
    for (std::size_t n = 0; n < 3; ++n) {
      const double room = 4 * std::numbers::pi - one.routes[n].free;
      const int carries = std::min(60, static_cast<int>(room / kStep_rad));
      EXPECT_EQ(one.routes[n].carries, carries) << n;
      EXPECT_EQ(one.routes[n].end, carries < 60 ? RouteEnd::kRewinds : RouteEnd::kNone);
    }
    EXPECT_EQ(one.routes[3].carries, 0) << "another branch is not followed";
  }
}

TEST(RouteFollower, IsOverWhereNoWayIsLeft) {
  Followed one(machine());
  one.add(0);
  const int taken = one.turn(200, one.sense());
  EXPECT_EQ(taken, one.routes[0].carries + 1);
}

TEST(RouteFollower, TakesTheTimeOfTheFeedOrOfTheJointThatIsSlowest) {
  Followed slow(machine()), fast(machine());
  for (Followed* one : {&slow, &fast}) one->add(0);
  (void)slow.turn(10, slow.sense(), 50);  // 50 mm at 50 mm/s each
  EXPECT_NEAR(slow.routes[0].time_s, 10, 0.3);
  (void)fast.turn(10, fast.sense());
  const double velocity = fast.model.joints[3].limits.velocity;
  EXPECT_NEAR(fast.routes[0].time_s, 10 * kStep_rad / velocity, 0.01);
  Followed inverse(machine());
  inverse.add(0);
  RouteFollower follower(inverse.model, inverse.model.tool_length_mm, {}, 0, inverse.start,
                         inverse.routes);
  ClBlock block = cut({1, 0, 0}, inverse.start.axis, 0.25);
  block.feed_meaning = FeedMeaning::kInverseTime;
  follower.follow(block);
  EXPECT_NEAR(inverse.routes[0].time_s, 4, 1e-6);
  ClBlock rapid = router::rapid({31, 0, 0}, inverse.start.axis);
  follower.follow(rapid);
  EXPECT_NEAR(inverse.routes[0].time_s, 4 + 30.0 / 300, 0.03) << "a rapid has no feed";
}

TEST(RouteFollower, LosesAWayForCertainWhereNoRewindHelps) {
  Followed one(machine(RewindPolicy::kRefuse));
  one.add(0);
  const int taken = one.turn(60, one.sense());
  const RouteAhead& route = one.routes[0];
  EXPECT_EQ(route.end, RouteEnd::kLost);
  EXPECT_EQ(route.lost.code, RejectCode::kTravelBetween);
  EXPECT_EQ(route.lost.joint, 3);
  EXPECT_EQ(route.lost.sequence, static_cast<std::uint64_t>(taken));
  EXPECT_EQ(route.lost.line, static_cast<std::uint32_t>(taken + 100));
  EXPECT_GT(route.lost.value, 4 * std::numbers::pi);
  EXPECT_LT(route.lost.value, 4 * std::numbers::pi + kStep_rad);
}

TEST(RouteFollower, IsInDoubtAsFarAsTipAndAxisMayMoveTheJoint) {
  for (const LookAheadSlack& slack : {LookAheadSlack{0.2, 0}, LookAheadSlack{0, 1e-3}}) {
    Followed one(machine(RewindPolicy::kRefuse), 0, slack);
    const ToolPose end{{13, 7, 0}, tilted(0.3, 0.9)};
    const auto slide_at = [&](const ToolPose& pose) {
      return solve(one.model, one.model.tool_length_mm, pose, 0, one.joints).q[0];
    };
    const double there = slide_at(end);
    double spread = 0;
    for (int i = 0; i < 3; ++i) {
      ToolPose beside = end;
      beside.tip[i] += slack.tip_mm;
      spread += 1.5 * std::abs(slide_at(beside) - there);
    }
    const Vector3 across = end.axis.unitOrthogonal();
    for (const Vector3& side : {across, Vector3(end.axis.cross(across))}) {
      const Vector3 axis = (end.axis + slack.axis_rad * side).normalized();
      spread += 1.5 * std::abs(slide_at({end.tip, axis}) - there);
    }
    ASSERT_GT(spread, 1e-3);
    for (const double share : {0.97, 1.03}) {
      Followed other(machine(RewindPolicy::kRefuse), 0, slack);
      JointLimits& limits = other.model.joints[0].limits;
      const bool is_up = there > other.joints[0];
      (is_up ? limits.travel_max : limits.travel_min) = there + (is_up ? -share : share) * spread;
      other.add(0);
      RouteFollower follower(other.model, other.model.tool_length_mm, slack, 0, other.start,
                             other.routes);
      // One step to the end: what leaves travel sooner is nearer to it.
      follower.follow(cut(end.tip, end.axis));
      EXPECT_EQ(other.routes[0].end, share < 1 ? RouteEnd::kDoubt : RouteEnd::kLost) << share;
    }
  }
}

TEST(RouteFollower, MayRewindToTheOtherBranchWhereTheTiltLeavesItsTravel) {
  for (const bool has_other : {true, false}) {
    Followed one(machine());
    JointLimits& tilt = one.model.joints[4].limits;
    const bool is_up = one.joints[4] > 0;
    (is_up ? tilt.travel_max : tilt.travel_min) = is_up ? 0.5 : -0.5;
    (is_up ? tilt.travel_min : tilt.travel_max) = (has_other ? 1 : 0.5) * (is_up ? -1 : 1);
    one.add(0);
    RouteFollower follower(one.model, one.model.tool_length_mm, {}, 0, one.start, one.routes);
    follower.follow(cut({0, 0, 0}, tilted(0.6, 0.4)));
    EXPECT_EQ(one.routes[0].end, has_other ? RouteEnd::kRewinds : RouteEnd::kLost);
  }
}

TEST(RouteFollower, FollowsAnArcAllTheWayRound) {
  for (const double limit : {15.0, 25.0}) {
    Followed one(machine(RewindPolicy::kRefuse));
    one.start = {{20, 0, 0}, tilted(0.3, 0)};
    one.joints = solve(one.model, one.model.tool_length_mm, one.start, 0, {}).q;
    for (std::size_t i = 0; i < 2; ++i) {
      one.model.joints[i].limits.travel_min = one.joints[i] - 20 - limit;
      one.model.joints[i].limits.travel_max = one.joints[i] + 20 + limit;
    }
    one.add(0);
    RouteFollower follower(one.model, one.model.tool_length_mm, {}, 0, one.start, one.routes);
    ClBlock arc = cut({20, 0, 0}, one.start.axis);
    arc.is_arc = true;
    arc.centre_mm = {0, 0, 0};
    arc.normal = {0, 0, 1};
    arc.sweep_rad = 2 * std::numbers::pi;
    follower.follow(arc);
    EXPECT_EQ(one.routes[0].carries, limit > 20 ? 1 : 0) << "40 mm away on the other side";
  }
}

TEST(RouteFollower, ARewindHelpsAJointOfOneTurnOnTheOtherBranchAlone) {
  for (const int branch : {0, 1}) {
    for (const bool has_other : {true, false}) {
      for (const double travel : {5.0, 7.0}) {
        Followed one(machine(), branch);
        const bool is_up = one.sense() > 0;
        JointLimits& c = one.model.joints[3].limits;
        c.travel_min = one.joints[3] - (is_up ? travel - 1 : 1);
        c.travel_max = c.travel_min + travel;
        if (!has_other) {  // the other branch tilts the other way
          JointLimits& tilt = one.model.joints[4].limits;
          (one.joints[4] > 0 ? tilt.travel_min : tilt.travel_max) = 0;
        }
        one.add(0);
        (void)one.turn(10, 1);
        EXPECT_EQ(one.routes[0].carries, 2);
        const bool helps = has_other || travel > kTurn_rad;
        EXPECT_EQ(one.routes[0].end, helps ? RouteEnd::kRewinds : RouteEnd::kLost) << travel;
      }
    }
  }
}

TEST(RouteFollower, EndsBesideThePole) {
  Followed one(machine());
  one.add(0);
  RouteFollower follower(one.model, one.model.tool_length_mm, {}, 0, one.start, one.routes);
  follower.follow(cut({5, 0, 0}, tilted(0.2, 0.4)));
  EXPECT_FALSE(follower.is_over());
  follower.follow(cut({10, 0, 0}, tilted(1e-4, 0.4)));
  EXPECT_TRUE(follower.is_over());
  EXPECT_EQ(one.routes[0].carries, 1);
  EXPECT_EQ(one.routes[0].end, RouteEnd::kNone) << "the branch may be chosen anew there";
}

TEST(RouteFollower, FollowsAStartBesideThePoleOutButSeesNothingFromThePole) {
  for (const double tilt : {0.0, 1e-4}) {
    Followed one(machine());
    one.add(0);
    const ToolPose start{{0, 0, 0}, tilted(tilt, 0.4)};
    RouteFollower follower(one.model, one.model.tool_length_mm, {}, 0, start, one.routes);
    EXPECT_EQ(follower.is_over(), tilt == 0);
    if (tilt == 0) continue;
    follower.follow(cut({5, 0, 0}, tilted(0.3, 0.4)));
    EXPECT_FALSE(follower.is_over());
    EXPECT_EQ(one.routes[0].carries, 1);
    follower.follow(cut({10, 0, 0}, tilted(1e-4, 0.4)));
    EXPECT_TRUE(follower.is_over()) << "once it is out it ends there as ever";
  }
}

TEST(RouteFollower, LosesNoWayThatARunBesideThePoleMayLeave) {
  for (const double slack_rad : {0.0, 1e-3}) {
    Followed one(machine(RewindPolicy::kRefuse), 0, {0, slack_rad});
    one.start.axis = tilted(1e-4, 0.4);
    one.joints = solve(one.model, one.model.tool_length_mm, one.start, 0, {}).q;
    one.model.joints[0].limits.travel_max = one.joints[0] + 5;
    one.model.joints[0].limits.travel_min = one.joints[0] - 5;
    one.add(0);
    RouteFollower follower(one.model, one.model.tool_length_mm, one.slack, 0, one.start,
                           one.routes);
    follower.follow(cut({50, 0, 0}, tilted(0.3, 0.4)));
    EXPECT_EQ(one.routes[0].end, slack_rad > 0 ? RouteEnd::kDoubt : RouteEnd::kLost);
  }
}

TEST(RouteFollower, BehindAToolBlockRotaryJointsAloneCount) {
  for (const bool has_tool : {false, true}) {
    Followed one(machine(RewindPolicy::kRefuse));
    one.model.joints[0].limits.travel_max = one.joints[0] + 5;
    one.model.joints[0].limits.travel_min = one.joints[0] - 5;
    one.add(0);
    RouteFollower follower(one.model, one.model.tool_length_mm, {}, 0, one.start, one.routes);
    ClBlock tool = cut({0, 0, 0}, one.start.axis);
    tool.kind = BlockKind::kTool;
    if (has_tool) follower.follow(tool);
    follower.follow(cut({50, 0, 0}, one.start.axis));
    EXPECT_EQ(one.routes[0].end, has_tool ? RouteEnd::kNone : RouteEnd::kLost);
    EXPECT_EQ(one.routes[0].carries, has_tool ? 2 : 0) << "a block without motion carries too";
    if (!has_tool) continue;
    for (int n = 0; n < 60; ++n) {
      follower.follow(cut({50, 0, 0}, tilted(0.3, 0.4 + one.sense() * kStep_rad * (n + 1))));
    }
    EXPECT_EQ(one.routes[0].lost.joint, 3);
  }
}

TEST(RouteFollower, AWayIntoABoxComesBehindTheOthers) {
  Followed plain(machine()), box(machine()), tip(machine());
  const JointVector there = solve(box.model, box.model.tool_length_mm,
                                  ToolPose{{10, 0, 0}, box.start.axis}, 0, box.joints)
                                .q;
  KeepOutBox wall;
  wall.joints = 0b1;
  wall.min = {there[0] - 0.5};
  wall.max = {there[0] + 0.5};
  ASSERT_TRUE(box.model.keep_out.add(wall));
  tip.model.tip_box = {true, {5000, 5000, 5000}, {5001, 5001, 5001}};
  for (Followed* one : {&plain, &box, &tip}) {
    one->add(0);
    RouteFollower follower(one->model, one->model.tool_length_mm, {}, 0, one->start, one->routes);
    follower.follow(cut({10, 0, 0}, one->start.axis));
    EXPECT_EQ(one->routes[0].end, one == &plain ? RouteEnd::kNone : RouteEnd::kDoubt);
    EXPECT_EQ(one->routes[0].carries, one == &plain ? 1 : 0);
  }
}

TEST(RouteFollower, EndsAtABlockThatIsNoPose) {
  Followed one(machine());
  one.add(0);
  RouteFollower follower(one.model, one.model.tool_length_mm, {}, 0, one.start, one.routes);
  follower.follow(cut({5, 0, 0}, {0.3, 0, 0.3}));
  EXPECT_TRUE(follower.is_over());
  EXPECT_EQ(one.routes[0].carries, 0);
  RouteFollower other(one.model, one.model.tool_length_mm, {}, 0, one.start, one.routes);
  other.follow(cut({std::nan(""), 0, 0}, one.start.axis));
  EXPECT_TRUE(other.is_over());
}

}  // namespace
}  // namespace meridian::test::route_follower
