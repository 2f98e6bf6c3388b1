// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_string.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "service/core/planner/singular/pole/pole_time.hpp"
#include "unit/planner/singular/walled_path.hpp"

namespace meridian::test::pole_string {
namespace {

using pole_walls::kTolerance_rad;
using pole_walls::Walled;

constexpr int kFree = 3;

/// The way of the redundant joint past the pole, `beside` off it.
struct Found {
  explicit Found(double beside, double winding_rad = 0, bool is_exact = false) : path(beside) {
    path.pass.known_end = 100;
    path.pass.joints[kFree] += winding_rad;
    path.task.is_exact = is_exact;
    const auto pieces = string.find(path.task, path.pass);
    zones.assign(pieces.begin(), pieces.end());
  }
  [[nodiscard]] double turn() const {
    return zones.back().free.back() - zones.front().free.front();
  }

  Walled path;
  PoleString string;
  std::vector<PoleZone> zones;
};

TEST(PoleString, LeadsThroughThePoleWhereTheToleranceLetsIt) {
  const Found one(0.0005);
  ASSERT_FALSE(one.zones.empty());
  EXPECT_FALSE(one.string.is_exact_best());
  EXPECT_TRUE(one.zones.front().is_through);
  EXPECT_NE(one.zones.back().branch_after, one.path.pass.branch);
  EXPECT_LT(std::abs(one.turn()), 0.2) << "the exact way turns by half a turn";
}

TEST(PoleString, CoversTheStretchInPiecesThatJoin) {
  for (const double beside : {0.0005, 0.002}) {
    const Found one(beside);
    ASSERT_FALSE(one.zones.empty());
    EXPECT_EQ(one.zones.front().begin, one.path.pass.begin);
    EXPECT_EQ(one.zones.back().end, one.path.pass.end);
    for (std::size_t n = 0; n < one.zones.size(); ++n) {
      const PoleZone& zone = one.zones[n];
      EXPECT_EQ(zone.is_first, n == 0);
      EXPECT_EQ(zone.is_last, n + 1 == one.zones.size());
      EXPECT_FALSE(zone.is_held);
      if (n == 0) continue;
      const PoleZone& before = one.zones[n - 1];
      EXPECT_EQ(zone.begin, before.end);
      const Jet<3> a = free_at(before.free, 1, before.end - before.begin);
      const Jet<3> b = free_at(zone.free, 0, zone.end - zone.begin);
      EXPECT_NEAR(value_of(a), value_of(b), 1e-9);
      EXPECT_NEAR(a.derivative(1), b.derivative(1), 1e-7);
      EXPECT_NEAR(a.derivative(2), b.derivative(2), 1e-5);
    }
  }
}

TEST(PoleString, KeepsTheAxisInsideItsToleranceAndMeetsTheExactWay) {
  for (const double beside : {0.0005, 0.002}) {
    const Found one(beside);
    ASSERT_FALSE(one.zones.empty());
    double largest = 0;
    for (const PoleZone& zone : one.zones) {
      for (int k = 0; k <= 50; ++k) {
        const double u = zone.begin + (zone.end - zone.begin) * k / 50;
        largest = std::max(largest, one.path.off_at(u, quintic_at(zone.free, k / 50.0)));
      }
    }
    EXPECT_LE(largest, kTolerance_rad);
    EXPECT_NEAR(one.zones.front().deviation_rad, largest, 0.1 * kTolerance_rad);
    const PolePass& pass = one.path.pass;
    EXPECT_NEAR(one.zones.front().free.front(), pass.joints[kFree], 1e-9);
    const JointVector end = one.path.joints_at(pass.end, one.zones.back().branch_after);
    EXPECT_NEAR(std::remainder(one.zones.back().free.back() - end[kFree], 2 * std::numbers::pi), 0,
                1e-6);
  }
}

TEST(PoleString, StaysOnTheWindingThatTheJointComesOn) {
  for (const double beside : {0.0005, 0.002}) {
    const Found one(beside), wound(beside, 2 * std::numbers::pi);
    ASSERT_EQ(wound.zones.size(), one.zones.size());
    EXPECT_NEAR(wound.zones.front().free.front() - one.zones.front().free.front(),
                2 * std::numbers::pi, 1e-9);
    EXPECT_NEAR(wound.turn(), one.turn(), 1e-9);
  }
}

TEST(PoleString, LeadsThroughWhereTheSmoothedAxisCountsInsteadOfTheProgrammed) {
  const Found one(0.0005, 0, true);
  ASSERT_FALSE(one.zones.empty());
  EXPECT_TRUE(one.zones.front().is_through);
}

TEST(PoleString, LeavesTheExactWayToItselfWhereItIsFaster) {
  const Found far(0.2);
  EXPECT_TRUE(far.zones.empty());
  EXPECT_TRUE(far.string.is_exact_best());
}

TEST(PoleString, TurnsOverOnlyWhereTheTiltKeepsItsTravelAfterwardsToo) {
  constexpr int kTilt = 4;
  for (const double room_rad : {0.2, 0.1}) {
    Walled path(0.0005);
    path.pass.known_end = 100;
    const double tilt = path.joints_at(100, 1)[kTilt];  // 0.16 rad to the other side
    JointLimits& limits = path.model.joints[kTilt].limits;
    (tilt < 0 ? limits.travel_min : limits.travel_max) = tilt < 0 ? -room_rad : room_rad;
    PoleString string;
    const auto pieces = string.find(path.task, path.pass);
    EXPECT_EQ(!pieces.empty() && pieces.front().is_through, room_rad > std::abs(tilt)) << tilt;
  }
}

TEST(PoleString, GoesOnWhereNoRouteBehindKeepsTravelForARewindMayHelp) {
  constexpr int kTilt = 4;
  Walled path(0.0005);
  path.pass.known_end = 100;
  path.model.joints[kTilt].limits.travel_min = -0.1;  // 0.16 rad at u = 100
  path.model.joints[kTilt].limits.travel_max = 0.1;
  PoleString string;
  const auto pieces = string.find(path.task, path.pass);
  ASSERT_FALSE(pieces.empty());
  EXPECT_TRUE(pieces.front().is_through) << "the shortest";
}

TEST(PoleString, FindsTheSameWhateverItFoundBefore) {
  constexpr std::array kBeside{0.0005, 0.2, 0.002, 0.0019, 0.01, 0.0024, 0.0005};
  PoleString again;
  for (const double off : {0.0, 0.0003}) {
    for (const double beside : kBeside) {
      Walled path(beside, Lean{0, off});
      path.pass.known_end = 100;
      PoleString fresh;
      const auto wanted = fresh.find(path.task, path.pass), got = again.find(path.task, path.pass);
      EXPECT_EQ(again.is_exact_best(), fresh.is_exact_best()) << beside;
      ASSERT_EQ(got.size(), wanted.size()) << beside;
      for (std::size_t n = 0; n < got.size(); ++n) EXPECT_EQ(got[n].free, wanted[n].free);
    }
  }
}

TEST(PoleString, EndsOnTheWindingThatACircleAboutThePoleTurnsTheJointTo) {
  for (const double whole_rad : {1.6 * std::numbers::pi, -1.6 * std::numbers::pi}) {
    const auto round = [whole_rad](double u) {
      const double azimuth = whole_rad * std::clamp((u - 50) / 20, 0.0, 1.0);
      const double away = std::max({0.0, 50 - u, u - 70});
      const double off = 0.003 + 0.004 * away;  // farther off than the tolerance
      return Lean{off * std::cos(azimuth), off * std::sin(azimuth)};
    };
    Walled path(120, round, 40, 80);
    path.pass.known_end = 100;
    PoleString string;
    const auto pieces = string.find(path.task, path.pass);
    ASSERT_FALSE(pieces.empty());
    const double turn = pieces.back().free.back() - pieces.front().free.front();
    EXPECT_NEAR(std::abs(turn), std::abs(whole_rad), 1e-6);
  }
}

/// Routes behind the stretch, on every winding of both branches; on branch 0 they carry farther.
std::vector<RouteAhead> routes_that_stay(const Walled& path) {
  std::vector<RouteAhead> routes;
  for (const int branch : {0, 1}) {
    const double free = path.joints_at(path.pass.known_end, branch)[kFree];
    for (const double turns : {-1, 0, 1}) {
      routes.push_back({branch, free + turns * 2 * std::numbers::pi, branch == 0 ? 5 : 3});
    }
  }
  return routes;
}

TEST(PoleString, StaysOnTheBranchFromWhichRoutesCarryFarther) {
  for (const int lost : {0, 1, 2}) {
    Walled path(0.0005);
    path.pass.known_end = 100;
    std::vector<RouteAhead> routes = routes_that_stay(path);
    // Windings that nothing leads to carry farthest.
    for (int n = 0; n < lost; ++n) routes.push_back({n, 50.0 + n, 8 + n});
    path.pass.ahead = routes;
    PoleString string;
    const auto pieces = string.find(path.task, path.pass);
    ASSERT_FALSE(pieces.empty());
    EXPECT_FALSE(pieces.front().is_through) << "shorter, but routes behind it carry 3 blocks";
    EXPECT_EQ(pieces.back().branch_after, 0);
  }
}

TEST(PoleString, EndsAsFastAsTheStringTurnsWhereTheStretchGoesOn) {
  constexpr double kRate = 0.08 * std::numbers::pi;
  for (const double rate : {kRate, -kRate}) {
    const auto round = [rate](double u) {
      const double azimuth = rate * std::clamp(u - 50, 0.0, 20.0);
      const double off = 0.01 + 0.004 * std::max({0.0, 50 - u, u - 70});
      return Lean{off * std::cos(azimuth), off * std::sin(azimuth)};
    };
    Walled path(120, round, 40, 60);
    path.pass.known_end = 100;
    path.pass.seen_end = 80;
    path.pass.at_end = PoleJoin::kHeld;
    PoleString string;
    const auto pieces = string.find(path.task, path.pass);
    ASSERT_FALSE(pieces.empty());
    const PoleZone& last = pieces.back();
    EXPECT_TRUE(last.is_held);
    const Jet<3> end = free_at(last.free, 1, last.end - last.begin);
    EXPECT_NEAR(end.derivative(1), rate, 0.1 * kRate);
  }
}

/// How much sooner than the exact way the pieces are at the end, by the limits at every place
/// alone.
double gain_s(const Found& found) {
  const PoleTask& task = found.path.task;
  const PolePass& pass = found.path.pass;
  constexpr int kSteps = 40;
  double gain = 0;
  for (const PoleZone& zone : found.zones) {
    const double h = zone.end - zone.begin;
    for (int k = 0; k < kSteps; ++k) {
      const double t = (k + 0.5) / kSteps, u = zone.begin + t * h;
      const BandSpan& span = task.spans.span_at(u);
      const auto pose = pose_of<Jet<3>>(span, u);
      const auto held =
          solve_held(task.model, pole_walls::kTool_mm, pose, free_at(zone.free, t, h));
      const auto exact = solve(task.model, pole_walls::kTool_mm, pose, pass.branch, pass.joints);
      gain +=
          h / kSteps *
          (slowness(task.model, span, pose, exact.q) - slowness(task.model, span, pose, held.q));
    }
  }
  return gain;
}

TEST(PoleString, IsTakenWhereItGainsMoreThanAMillisecond) {
  const Found one(0.0217), other(0.0238);
  ASSERT_FALSE(one.zones.empty());
  EXPECT_NEAR(gain_s(one), 0.0015, 0.0005);
  EXPECT_TRUE(other.zones.empty());
  EXPECT_TRUE(other.string.is_exact_best());
}

TEST(PoleString, LeavesToTheExactWayAStretchLongerThanItsPieces) {
  constexpr double kSpan_mm = 8;
  constexpr int kSpans = 400;  // pieces of 5 mm: more than a spline holds
  const Lean lean{0.001, 0};
  Walled path(0.001);
  path.probes.begin(true);
  path.programmed.begin(axis_of(lean));
  for (int n = 0; n < kSpans; ++n) {
    BandSpan span = leaning_span(n, lean, lean);
    span.u0 = kSpan_mm * n;
    span.length = kSpan_mm;
    span.c[0] = {0.5 * span.u0, 0.5};
    path.probes.push(span);
    path.programmed.add(span.u0 + kSpan_mm, axis_of(lean));
  }
  path.pass.begin = 10;
  path.pass.end = kSpan_mm * kSpans - 20;
  path.pass.known_end = kSpan_mm * kSpans - 10;
  path.pass.joints = path.joints_at(path.pass.begin, 0);
  PoleString string;
  EXPECT_TRUE(string.find(path.task, path.pass).empty());
  EXPECT_TRUE(string.is_exact_best());
}

}  // namespace
}  // namespace meridian::test::pole_string
