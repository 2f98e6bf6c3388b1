// SPDX-License-Identifier: Apache-2.0

/// A leg beside the pole: where it is cut, and by what its pieces run.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "meridian/path/build_piece.hpp"
#include "meridian/planner/profile.hpp"
#include "support/machines.hpp"
#include "unit/planner/feed/planned_leg.hpp"

namespace meridian::test::leg_runs {
namespace {

using leg_planner::Planned;

/// A leg of 1 mm whose axis goes from `begin` to `end` (tangents), `beside` the pole.
struct Beside {
  double beside = 0, begin = 0, end = 0;

  [[nodiscard]] PathFault plan(Planned& one) const {
    const ToolPose from{{0, 0, 0}, Vector3(begin, beside, 1).normalized()};
    const ToolPose to{{1, 0, 0}, Vector3(end, beside, 1).normalized()};
    return one.plan_line(from, to, 50);
  }
};

/// The fastest motion of the redundant joint alone, as planned.
double fastest_turn_s(double turn_rad) {
  const JointLimits limits = bench_machine().joints[3].limits;
  constexpr double kShare = 0.99;
  return rest_to_rest_with_reserve(turn_rad, {kShare * limits.velocity,
                                              kShare * limits.acceleration, kShare * limits.jerk})
      .duration();
}

TEST(LegRuns, LeadPastThePoleAtAnyDistanceInsideEveryLimit) {
  struct Case {
    Beside leg;
    double longest_s;  // what it took when this was written, and a hundredth
  };
  constexpr std::array kCases{Case{{1e-2, 0.3, -0.3}, 6.57}, Case{{3e-4, 0.3, -0.3}, 6.58},
                              Case{{1e-5, 0.3, -0.3}, 6.94}, Case{{1e-5, 0.02, -0.02}, 6.03},
                              Case{{1e-5, 0.15, 0.0}, 3.42}, Case{{1e-5, 0.0, -0.3}, 3.53}};
  for (const Case& a : kCases) {
    SCOPED_TRACE(testing::Message() << a.leg.beside << " from " << a.leg.begin);
    Planned one(bench_machine());
    ASSERT_FALSE(is_fault(a.leg.plan(one)));
    EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
    const double turn = std::abs(one.joints[3] - one.start[3]);
    EXPECT_NEAR(turn, std::atan2(a.leg.begin, a.leg.beside) - std::atan2(a.leg.end, a.leg.beside),
                1e-6);
    EXPECT_GT(duration_of(*one.staged), fastest_turn_s(turn));
    EXPECT_LT(duration_of(*one.staged), a.longest_s);
    expect_joined(one);
  }
}

TEST(LegRuns, AreOnePieceByAzimuthWhereTheRedundantJointHasFarthestToGo) {
  bool is_azimuthal = false;
  for (const double end : {0.0, -0.02}) {
    Planned one(bench_machine());
    ASSERT_FALSE(is_fault(Beside{3e-3, 0.02, end}.plan(one)));
    ASSERT_EQ(one.staged->path_count, 1);
    EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
    const double turn = std::abs(one.joints[3] - one.start[3]);
    const double over_turn = duration_of(*one.staged) / fastest_turn_s(turn);
    EXPECT_LT(over_turn, 1.01) << "it bounds the motion";
    EXPECT_TRUE(one.staged->paths[0].is_azimuthal || over_turn < 1) << "else the feed does better";
    is_azimuthal = is_azimuthal || one.staged->paths[0].is_azimuthal;
  }
  EXPECT_TRUE(is_azimuthal);
}

TEST(LegRuns, AreTheSameWhateverWasPlannedBefore) {
  constexpr std::array kLegs{Beside{1e-5, 0.3, -0.3}, Beside{3e-3, 0.02, -0.02},
                             Beside{3e-2, 0.3, 0.15}, Beside{1e-5, 0.15, 0.0}};
  Planned again(bench_machine());
  for (const Beside& leg : kLegs) {
    Planned fresh(bench_machine());
    again.staged->clear(100);
    ASSERT_FALSE(is_fault(leg.plan(fresh)));
    ASSERT_FALSE(is_fault(leg.plan(again)));
    EXPECT_EQ(again.staged->path_count, fresh.staged->path_count);
    ASSERT_EQ(again.staged->time_count, fresh.staged->time_count);
    for (int n = 0; n < fresh.staged->time_count; ++n) {
      EXPECT_EQ(again.staged->times[n].duration, fresh.staged->times[n].duration) << n;
      EXPECT_EQ(again.staged->times[n].stop_jerk, fresh.staged->times[n].stop_jerk) << n;
    }
    EXPECT_EQ(again.joints, fresh.joints);
  }
}

TEST(LegRuns, LeadRoundAFullCircleToTheSideOfThePole) {
  for (const double beside : {1e-2, 1e-4, 2e-5}) {
    Planned one(bench_machine());
    const ToolPose from{{5, 0, 0}, Vector3(0.3, beside, 1).normalized()};
    const ToolPose to{{5, 0, 0}, Vector3(0, beside, 1).normalized()};
    ClBlock circle;
    circle.is_arc = true;
    circle.tip_mm = to_array(to.tip);
    circle.sweep_rad = 2 * std::numbers::pi;
    Leg leg;
    leg.path = make_arc(from, to, circle);
    leg.feed_mm_per_s = 50;
    const JointVector begin = solve(one.model, one.model.tool_length_mm, from, 0, {}).q;
    ASSERT_FALSE(is_fault(one.plan(leg, begin))) << beside;
    EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
    EXPECT_LE(tip_speed_of(*one.staged), 50);
    expect_joined(one);
  }
}

}  // namespace
}  // namespace meridian::test::leg_runs
