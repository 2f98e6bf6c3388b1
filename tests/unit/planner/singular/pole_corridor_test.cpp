// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_corridor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "support/machines.hpp"
#include "unit/planner/singular/handed_path.hpp"

namespace meridian::test::pole_corridor {
namespace {

TEST(PoleCorridor, HandsOnWhatIsFarFromThePoleAtOnceAndAsItIs) {
  Handed handed(bench_machine(), leaning_path(40, [](double u) {
                  return Lean{0.4 + 0.002 * u, 0.1};
                }));
  handed.run();
  ASSERT_EQ(handed.out.size(), 40U);
  expect_whole(handed);
  EXPECT_FALSE(handed.is_driven());
  EXPECT_LE(handed.farthest_held, 2);
  for (const JointSpan& span : handed.out) EXPECT_EQ(span.branch, 0);
}

TEST(PoleCorridor, HoldsNoMoreBackThanItNeedsToKnow) {
  for (const double beside : {0.0005, 0.01, 0.1}) {
    Handed handed(bench_machine(), leaning_path(120, passing(beside)));
    handed.run();
    expect_whole(handed);
    EXPECT_LE(handed.farthest_held, 64) << beside;
    EXPECT_GT(handed.farthest_held, 20) << beside;
  }
}

TEST(PoleCorridor, GoesAShorterWayInsideTheTolerance) {
  Handed handed(bench_machine(), leaning_path(120, passing(0.0005)));
  handed.run();
  expect_whole(handed);
  ASSERT_TRUE(handed.is_driven());
  const FollowedPath followed = follow(handed);
  EXPECT_LT(followed.turn, 1) << "the exact way is half a turn";
  EXPECT_LE(followed.farthest_rad, kTolerance_rad);
  EXPECT_LT(followed.jump, 1e-7);
  EXPECT_LT(followed.jump_d1, 1e-5);
  double reported = 0;
  for (const JointSpan& span : handed.out) {
    if (!span.is_free_driven) continue;
    reported = std::max(reported, span.axis_deviation_rad);
    EXPECT_EQ(span.reason, RelaxedReason::kThrough);
    EXPECT_GT(span.band.u0, 60 - 40);
    EXPECT_LT(span.band.u0, 60 + 40);
  }
  EXPECT_GE(reported, followed.farthest_rad * (1 - 1e-3));
  EXPECT_LE(reported, kTolerance_rad);
  EXPECT_NE(handed.out.back().branch, handed.out.front().branch) << "out on the other branch";
}

TEST(PoleCorridor, UsesAllOfItsReachWhereThePathLeadsThroughThePole) {
  Handed handed(bench_machine(), leaning_path(120, passing(0)));
  handed.run();
  expect_whole(handed);
  ASSERT_TRUE(handed.is_driven());
  double begin = 120, end = 0;
  for (const JointSpan& span : handed.out) {
    if (!span.is_free_driven) continue;
    begin = std::min(begin, span.band.u0);
    end = std::max(end, span.band.u0 + span.band.length);
  }
  EXPECT_LT(begin, 60 - kPoleReach_mm);
  EXPECT_GT(end, 60 + kPoleReach_mm);
}

TEST(PoleCorridor, FollowsThePathOnItsBranchBesideAPoleThatIsFarther) {
  for (const int branch : {0, 1}) {
    Handed handed(bench_machine(), leaning_path(120, passing(0.006)), branch);
    handed.run();
    expect_whole(handed);
    const FollowedPath followed = follow(handed);
    EXPECT_LE(followed.farthest_rad, kTolerance_rad);
    EXPECT_LT(followed.jump, 1e-6);
    EXPECT_GT(followed.turn, 2.5);
    EXPECT_EQ(handed.out.back().branch, branch);
  }
}

TEST(PoleCorridor, CutsSpansAboutTheNearestPointWhereTheWayIsExact) {
  MachineModel model = bench_machine();
  model.pole_policy = PolePolicy::kExact;
  Handed handed(model, leaning_path(120, passing(0.0005)));
  handed.run();
  expect_whole(handed);
  EXPECT_FALSE(handed.is_driven());
  const auto shortest = std::min_element(
      handed.out.begin(), handed.out.end(),
      [](const JointSpan& a, const JointSpan& b) { return a.band.length < b.band.length; });
  EXPECT_NEAR(shortest->band.u0, 60, 0.1);
  EXPECT_LT(shortest->band.length, 0.5 * 0.0005 / 0.004) << "half of the width of the turn";
  for (const JointSpan& span : handed.out) {
    if (std::abs(span.band.u0 - 60) > 7) {
      EXPECT_NEAR(span.band.length, 1, 1e-9);
    }
  }
  const FollowedPath followed = follow(handed);
  EXPECT_NEAR(followed.turn, std::numbers::pi, 0.02);
  EXPECT_LT(followed.farthest_rad, 1e-9);
}

TEST(PoleCorridor, GivesTheSameHoweverTheSpansCome) {
  Handed one(bench_machine(), leaning_path(120, passing(0.0009)));
  Handed many(bench_machine(), leaning_path(120, passing(0.0009)));
  one.run(1);
  many.run(7);
  ASSERT_EQ(one.out.size(), many.out.size());
  for (std::size_t n = 0; n < one.out.size(); ++n) {
    EXPECT_EQ(one.out[n].band.u0, many.out[n].band.u0);
    EXPECT_EQ(one.out[n].free, many.out[n].free);
    EXPECT_EQ(one.out[n].branch, many.out[n].branch);
  }
  one.run(1);  // a path begins afresh
  ASSERT_EQ(one.out.size(), many.out.size());
  EXPECT_EQ(one.out.back().free, many.out.back().free);
}

TEST(PoleCorridor, ComesToRestOnThePole) {
  // Straight to the pole and no farther; exactly there at the end.
  const auto lean = [](double u) { return Lean{0.002 * (60 - u), 0}; };
  Handed handed(bench_machine(), leaning_path(60, lean));
  handed.run();
  expect_whole(handed);
  const FollowedPath followed = follow(handed);
  EXPECT_LT(followed.turn, 1e-3);
  EXPECT_LE(followed.farthest_rad, kTolerance_rad);
}

TEST(PoleCorridor, LeavesThePoleWhereThePathBegins) {
  const auto lean = [](double u) { return Lean{0.002 * u, 0.0006}; };
  Handed handed(bench_machine(), leaning_path(60, lean));
  handed.run();
  expect_whole(handed);
  const FollowedPath followed = follow(handed);
  EXPECT_LE(followed.farthest_rad, kTolerance_rad);
  EXPECT_LT(followed.jump, 1e-6);
  EXPECT_LT(followed.turn, 1.6);
}

TEST(PoleCorridor, HoldsTheJointAtRestWhileThePathStaysOnThePole) {
  const auto lean = [](double u) {
    if (u < 50) return Lean{0.004 * (50 - u), 0};
    if (u > 250) return Lean{0, 0.004 * (u - 250)};
    return Lean{0.0002 * std::sin(u), 0.0002 * std::cos(u)};
  };
  Handed handed(bench_machine(), leaning_path(300, lean));
  handed.run();
  expect_whole(handed);
  const FollowedPath followed = follow(handed);
  EXPECT_LE(followed.farthest_rad, kTolerance_rad);
  EXPECT_LT(followed.jump, 1e-6);
  EXPECT_LT(followed.jump_d1, 1e-4);
  EXPECT_NEAR(followed.turn, std::numbers::pi / 2, 0.3) << "a quarter turn, spread over the stay";
  EXPECT_LE(handed.farthest_held, 104);
}

TEST(PoleCorridor, HandsSpansOnAsTheyAreWhereAllOfThePathIsOnThePole) {
  Handed handed(bench_machine(), leaning_path(50, [](double) { return Lean{}; }));
  handed.start.is_on_pole = true;
  handed.run();
  ASSERT_EQ(handed.out.size(), 50U);
  expect_whole(handed);
  EXPECT_FALSE(handed.is_driven());
  EXPECT_LE(handed.farthest_held, 2);
}

TEST(PoleCorridor, KnowsTheSpanThatIsHeldFirst) {
  Handed handed(bench_machine(), leaning_path(120, passing(0.0005)));
  handed.begin();
  EXPECT_EQ(handed.corridor.first_held(), nullptr);
  for (std::size_t n = 0; n < 50; ++n) {
    handed.push(n);
    handed.read();
  }
  ASSERT_NE(handed.corridor.first_held(), nullptr);
  EXPECT_EQ(handed.corridor.first_held()->u0, std::floor(handed.end_of_out() + 1e-9));
  EXPECT_FALSE(handed.corridor.has_failed());
  EXPECT_FALSE(handed.corridor.needs_ahead());
}

/// The machine is wound by a whole turn in the middle of a zone or ahead of one.
TEST(PoleCorridor, GoesOnOnAnotherWinding) {
  for (const double until : {15.0, 39.2, 58.0}) {
    Handed handed(bench_machine(), leaning_path(120, passing(0.0005)));
    handed.begin();
    std::size_t n = 0;
    for (; n < handed.path.size() && handed.end_of_out() < until; ++n) {
      handed.push(n);
      while (handed.end_of_out() < until) {
        const JointSpan* span = handed.corridor.next();
        if (span == nullptr) break;
        handed.out.push_back(*span);
      }
    }
    JointVector q = follow(handed).end;
    const std::size_t wound_at = handed.out.size();
    q[3] += kTurn_rad;
    handed.corridor.wind(kTurn_rad, q);
    handed.read();
    for (; n < handed.path.size(); ++n) {
      handed.push(n);
      handed.read();
    }
    handed.corridor.finish();
    handed.read();
    expect_whole(handed);
    const FollowedPath followed = follow(handed.model, q, std::span(handed.out).subspan(wound_at));
    EXPECT_LT(followed.jump, 1e-6) << until;
    EXPECT_LE(followed.farthest_rad, kTolerance_rad) << until;
    EXPECT_LT(followed.turn, 1.5) << until;
    EXPECT_GT(followed.end[3], q[3] - 2) << until;
  }
}

/// A path `beside` the pole that is handed out up to `until`, in a zone. The
/// redundant joint has ends of travel, far off.
struct InZone : Handed {
  InZone(double beside, double until)
      : Handed(bench_machine(), leaning_path(120, passing(beside))) {
    model.joints[3].is_endless = false;
    leave_room(100);
    begin();
    for (std::size_t n = 0; end_of_out() < until; ++n) {
      push(n);
      while (end_of_out() < until) {
        const JointSpan* span = corridor.next();
        if (span == nullptr) break;
        out.push_back(*span);
      }
    }
  }
  /// The redundant joint may go no farther than `room_rad` either way from where it is.
  void leave_room(double room_rad) {
    const double at = out.empty() ? 0 : out.back().free[5];
    model.joints[3].limits.travel_min = at - room_rad;
    model.joints[3].limits.travel_max = at + room_rad;
  }
};

TEST(PoleCorridor, AnythingFitsWhereNoZoneIsPartlyOut) {
  Handed handed(bench_machine(), leaning_path(120, passing(0.0005)));
  handed.begin();
  EXPECT_TRUE(handed.corridor.fits_zone(1000));
}

TEST(PoleCorridor, SaysWhetherTheRestOfAZoneFitsTravelAnotherWinding) {
  InZone one(0.0005, 59);
  ASSERT_TRUE(one.out.back().is_free_driven);
  one.leave_room(9);
  EXPECT_TRUE(one.corridor.fits_zone(0));
  EXPECT_TRUE(one.corridor.fits_zone(kTurn_rad));
  EXPECT_TRUE(one.corridor.fits_zone(-kTurn_rad));
  EXPECT_FALSE(one.corridor.fits_zone(2 * kTurn_rad));
  EXPECT_FALSE(one.corridor.fits_zone(-2 * kTurn_rad));
}

TEST(PoleCorridor, SaysThatAZoneDoesNotFitWhoseLaterPiecesLeaveTravel) {
  InZone one(0.0025, 50);
  ASSERT_TRUE(one.out.back().is_free_driven);
  one.leave_room(4);
  EXPECT_TRUE(one.corridor.fits_zone(0));
  one.leave_room(1.5);
  EXPECT_FALSE(one.corridor.fits_zone(0)) << "it turns by nearly half a turn yet";
}

}  // namespace
}  // namespace meridian::test::pole_corridor
