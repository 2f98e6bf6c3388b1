// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole_stretches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

namespace meridian::test::pole_stretches {
namespace {

using Answer = PoleStretches::Answer;

/// Close to the pole is what is nearer than 0.005 rad; a path is waited for up to 0.01 rad.
constexpr double kTolerance_rad = 0.002;
constexpr double kProbe_mm = 1.0 / PoleProbes::kProbes;

/// Past the pole at `at`, `beside` off it: 0.004 rad a mm.
auto passing(double beside, double at = 60) {
  return [=](double u) { return Lean{0.004 * (u - at), beside}; };
}

/// Stretches of a path, as far as it is pushed.
struct Stretched {
  template <class LeanAt>
  Stretched(int count, const LeanAt& lean, int pushed = 1000) : path(leaning_path(count, lean)) {
    probes.begin(true);
    stretches.begin(kTolerance_rad);
    push(std::min(count, pushed));
    settled.is_whole = pushed >= count;
  }
  void push(int count) {
    for (int n = 0; n < count; ++n) probes.push(path[next++]);
  }
  /// The answer at the next place; nothing found counts as kNeedsSpans.
  Answer ask() {
    return stretches.find_next(settled) ? stretches.decide(out) : Answer::kNeedsSpans;
  }

  MachineModel model = bench_machine();
  std::vector<BandSpan> path;
  std::size_t next = 0;
  PoleProbes probes{model};
  PoleStretches stretches{probes};
  SettledPath settled;
  PoleStretch out;
};

TEST(PoleStretches, FindTheStretchAboutThePoleAndTheRoomBesideIt) {
  Stretched one(120, passing(0.0005));
  one.settled.branch = 1;
  ASSERT_EQ(one.ask(), Answer::kFound);
  // |0.004 (u - 60)| < √(0.005² - 0.0005²): 1.24 mm to either side.
  EXPECT_NEAR(one.out.close_begin, 60 - 7 * kProbe_mm, 1e-9);
  EXPECT_NEAR(one.out.close_end, 60 + 7 * kProbe_mm, 1e-9);
  EXPECT_EQ(one.out.first, 353);
  EXPECT_EQ(one.out.last, 367);
  EXPECT_NEAR(one.out.nearest, one.out.close_begin, 1e-9);
  EXPECT_TRUE(one.out.has_room);
  const PolePlace& place = one.out.place;
  EXPECT_NEAR(place.begin, one.out.close_begin - kPoleReach_mm, 1e-9);
  EXPECT_NEAR(place.end, one.out.close_end + kPoleReach_mm, 1e-9);
  EXPECT_NEAR(place.known_end, one.out.close_end + 2 * kPoleReach_mm, 1e-9);
  EXPECT_EQ(place.at_begin, PoleJoin::kExact);
  EXPECT_EQ(place.at_end, PoleJoin::kExact);
  EXPECT_EQ(place.branch, 1);
  EXPECT_EQ(one.stretches.place(), 368);
  EXPECT_FALSE(one.stretches.find_next(one.settled)) << "there is no other";
}

TEST(PoleStretches, WaitUntilEnoughOfThePathIsKnownBehind) {
  Stretched one(140, passing(0.0005), 60);
  int asked = 0;
  while (one.ask() != Answer::kFound) {
    one.push(1);
    ++asked;
    ASSERT_LT(one.next, 140U);
  }
  // 61.17 is the end of what is close; two reaches and a mm are known behind it.
  EXPECT_EQ(one.next, 103U);
  EXPECT_EQ(one.out.first, 353);
  EXPECT_EQ(one.out.last, 367);
}

TEST(PoleStretches, FindAMinimumThatIsFartherOffWithoutRoomForAnotherWay) {
  Stretched one(120, passing(0.03));
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.nearest, 60, 1e-6);
  EXPECT_EQ(one.out.first, 360);
  EXPECT_EQ(one.out.last, 360);
  EXPECT_FALSE(one.out.has_room);
  EXPECT_TRUE(one.stretches.is_minimum(360));
  EXPECT_FALSE(one.stretches.is_minimum(359));
  EXPECT_FALSE(one.stretches.is_minimum(361));
  EXPECT_EQ(one.stretches.place(), 361);
  one.stretches.go_back_to(360);
  one.settled.end = 59.99;
  EXPECT_EQ(one.ask(), Answer::kFound);
  Stretched far(120, passing(0.06));
  EXPECT_FALSE(far.stretches.find_next(far.settled)) << "it turns the joint gently";
}

TEST(PoleStretches, CompareTheLastProbeWithTheEndOfThePath) {
  const PoleProbes::Place last = 40 * PoleProbes::kProbes - 1;
  Stretched on(40, passing(0.03, 39.8)), before(40, passing(0.03, 40)),
      on_rise(40, passing(0.03, 39));
  EXPECT_TRUE(on.stretches.is_minimum(last));
  EXPECT_FALSE(before.stretches.is_minimum(last)) << "the end of the path is closer";
  EXPECT_FALSE(on_rise.stretches.is_minimum(last));
  EXPECT_FALSE(Stretched(40, passing(0.03, -1)).stretches.is_minimum(0)) << "nothing is before";
}

TEST(PoleStretches, PassOverWhatIsSettledAlready) {
  Stretched minimum(120, passing(0.03, 60.05));
  minimum.settled = {60.0, true, false, true, 0};
  ASSERT_TRUE(minimum.stretches.find_next(minimum.settled));
  EXPECT_EQ(minimum.stretches.decide(minimum.out), Answer::kFound) << "60.05 lies behind 60";
  minimum.stretches.begin_again();
  minimum.settled.end = 60.1;
  EXPECT_FALSE(minimum.stretches.find_next(minimum.settled));

  Stretched inside(120, passing(0.0005));
  inside.settled = {60.0, true, false, true, 0};
  EXPECT_EQ(inside.ask(), Answer::kPassed);
  EXPECT_FALSE(inside.out.has_room);
  Stretched behind(120, passing(0.0005));
  behind.settled = {70.0, true, false, true, 0};
  EXPECT_FALSE(behind.stretches.find_next(behind.settled));
}

TEST(PoleStretches, BeginWhereTheMachineRestsIfThePoleIsNearTheBeginOfThePath) {
  Stretched one(120, passing(0.0005, 10));
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.place.at_begin, PoleJoin::kRest);
  EXPECT_EQ(one.out.place.begin, 0);
  EXPECT_TRUE(one.out.has_room);
  Stretched begun(120, passing(0.0005, 10));
  begun.settled.is_begun = true;
  ASSERT_EQ(begun.ask(), Answer::kFound);
  EXPECT_EQ(begun.out.place.at_begin, PoleJoin::kExact);
  const double close = 10 - 7 * kProbe_mm;
  EXPECT_NEAR(begun.out.place.begin, close - 0.98 * close, 1e-9);
}

TEST(PoleStretches, EndAtRestWhereThePathEndsBesideThePole) {
  Stretched at_rest(62, passing(0.0005));  // it ends 0.008 rad off the pole
  ASSERT_EQ(at_rest.ask(), Answer::kFound);
  EXPECT_EQ(at_rest.out.place.at_end, PoleJoin::kRest);
  EXPECT_EQ(at_rest.out.place.end, 62);
  EXPECT_EQ(at_rest.out.place.known_end, 62);
  Stretched exact(63, passing(0.0005));  // 0.012 rad
  ASSERT_EQ(exact.ask(), Answer::kFound);
  EXPECT_EQ(exact.out.place.at_end, PoleJoin::kExact);
  const double close = 60 + 7 * kProbe_mm;
  EXPECT_NEAR(exact.out.place.end, close + 0.98 * (63 - close), 1e-9);
  Stretched last(60, passing(0.0005));  // closest at its very end
  ASSERT_EQ(last.ask(), Answer::kFound);
  EXPECT_EQ(last.out.place.end, 60);
  EXPECT_EQ(last.out.place.at_end, PoleJoin::kRest);
}

TEST(PoleStretches, GoOnFromAStretchWhoseEndIsHeld) {
  Stretched one(120, passing(0.0005));
  one.settled = {60.1, true, true, true, 0};
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.place.at_begin, PoleJoin::kHeld);
  EXPECT_EQ(one.out.place.begin, 60.1);
  EXPECT_EQ(one.out.close_begin, 60.1);
  EXPECT_NEAR(one.out.close_end, 60 + 7 * kProbe_mm, 1e-9);
  Stretched far(120, passing(0.0005));  // and though nothing is close there any more
  far.settled = {90.1, true, true, true, 0};
  ASSERT_EQ(far.ask(), Answer::kFound);
  EXPECT_EQ(far.out.place.at_begin, PoleJoin::kHeld);
  EXPECT_EQ(far.out.place.begin, 90.1);
}

/// All of it close to the pole; closest at u = 30.
auto along(double u) { return Lean{0.001 + 2e-5 * std::abs(u - 30), 0.0005}; }

TEST(PoleStretches, GoOnBehindAPlaceOfAStretchThatIsLong) {
  Stretched one(300, along, 10);
  while (one.ask() != Answer::kFound) {
    one.push(1);
    ASSERT_LT(one.next, 300U);
  }
  EXPECT_EQ(one.next, 81U) << "four reaches, and the span whose last probe waits for the next";
  const PolePlace& place = one.out.place;
  EXPECT_EQ(place.at_begin, PoleJoin::kRest);
  EXPECT_EQ(place.at_end, PoleJoin::kHeld);
  EXPECT_NEAR(place.end, 30, 1e-9) << "where it is closest, well ahead of what is known";
  EXPECT_EQ(one.out.last, 180);
  EXPECT_GT(place.seen_end, 80 - 1e-9);
  EXPECT_EQ(place.known_end, place.seen_end);
  EXPECT_TRUE(one.out.has_room);
  EXPECT_EQ(one.stretches.place(), 181);
}

/// Close to the pole at 60 and at 70; `peak` off it between them.
auto twice(double peak) {
  return [peak](double u) {
    if (u <= 60) return Lean{0.004 * (u - 60), 0.0005};
    if (u >= 70) return Lean{0.004 * (u - 70), 0.0005};
    return Lean{peak * (1 - std::abs(u - 65) / 5), 0.0005};
  };
}

TEST(PoleStretches, TakeForOneStretchWhatIsNearThePoleInBetween) {
  Stretched one(140, twice(0.0095));
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.close_begin, 60 - 7 * kProbe_mm, 1e-9);
  EXPECT_NEAR(one.out.close_end, 70 + 7 * kProbe_mm, 1e-9);
  EXPECT_FALSE(one.stretches.find_next(one.settled));
}

TEST(PoleStretches, LeaveRoomToTheNextStretchBehind) {
  Stretched one(140, twice(0.02));
  ASSERT_EQ(one.ask(), Answer::kFound);
  const double end = 60 + 7 * kProbe_mm, other = 70 - 7 * kProbe_mm;
  EXPECT_NEAR(one.out.close_end, end, 1e-9);
  EXPECT_NEAR(one.out.place.end, end + 0.49 * (other - end), 1e-9);
  one.settled.is_begun = true;
  one.settled.end = one.out.place.end;
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.close_begin, other, 1e-9);
  EXPECT_NEAR(one.out.place.begin, other - 0.98 * (other - one.settled.end), 1e-9);
}

TEST(PoleStretches, CanBeShortenedWhereTheExactWayLeadsThere) {
  Stretched one(120, passing(0.0005));
  ASSERT_EQ(one.ask(), Answer::kFound);
  PoleStretch both = one.out, none = one.out, snapped = one.out, rest = one.out, held = one.out;
  EXPECT_TRUE(one.stretches.shorten(both, 5));
  EXPECT_NEAR(both.place.begin, both.close_begin - 5, 1e-9);
  EXPECT_NEAR(both.place.end, both.close_end + 5, 1e-9);
  EXPECT_FALSE(one.stretches.shorten(none, 30));
  EXPECT_EQ(none.place.begin, one.out.place.begin);
  EXPECT_EQ(none.place.end, one.out.place.end);
  // No part of a span that is shorter than 0.1 µm is left over.
  EXPECT_TRUE(one.stretches.shorten(snapped, 5 * kProbe_mm + 5e-5));
  EXPECT_EQ(snapped.place.begin, 58);
  EXPECT_EQ(snapped.place.end, 62);
  rest.place.at_begin = rest.place.at_end = PoleJoin::kRest;
  EXPECT_TRUE(one.stretches.shorten(rest, 5));
  EXPECT_EQ(rest.place.at_begin, PoleJoin::kExact);
  EXPECT_EQ(rest.place.end, one.out.place.end) << "a rest at the end stays";
  held.place.at_begin = PoleJoin::kHeld;
  EXPECT_TRUE(one.stretches.shorten(held, 5));
  EXPECT_EQ(held.place.begin, one.out.place.begin);
  held = one.out;
  held.place.at_begin = held.place.at_end = PoleJoin::kHeld;
  EXPECT_FALSE(one.stretches.shorten(held, 5));
}

TEST(PoleStretches, HaveNoRoomWhereWhatIsSettledReachesToWhatIsClose) {
  for (const double left : {1e-4, 0.1}) {
    Stretched one(120, passing(0.0005));
    one.settled = {60 - 7 * kProbe_mm - left, true, false, true, 0};
    ASSERT_EQ(one.ask(), Answer::kFound);
    EXPECT_EQ(one.out.has_room, left > 0.01);
  }
}

TEST(PoleStretches, EndWhereAMinimumBehindTheLastProbeIs) {
  // Only the minimum at 59.9 is close, beside both of its neighbours.
  Stretched one(120, [](double u) { return Lean{0.05 * (u - 59.9), 0.004}; });
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.close_begin, std::min(one.probes.u_of(one.out.first), 59.9), 1e-6);
  EXPECT_NEAR(one.out.close_end, std::max(one.probes.u_of(one.out.last), 59.9), 1e-6);
  EXPECT_LE(one.out.close_begin, 59.9);
  EXPECT_GE(one.out.close_end, 59.9 - 1e-6);
}

TEST(PoleStretches, LookAgainAtAllThatIsHeldBack) {
  Stretched one(120, passing(0.0005));
  ASSERT_EQ(one.ask(), Answer::kFound);
  one.stretches.begin_again();
  EXPECT_EQ(one.stretches.place(), 0);
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.first, 353);
  one.stretches.begin(10 * kTolerance_rad);
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.close_begin, 60 - 12.5, kProbe_mm) << "ten times as far";
}

}  // namespace
}  // namespace meridian::test::pole_stretches
