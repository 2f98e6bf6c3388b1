// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_stretches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/planner/singular/stretched_path.hpp"

namespace meridian::test::pole_stretches {
namespace {

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
  const PolePass& pass = one.out.pass;
  EXPECT_NEAR(pass.begin, one.out.close_begin - kPoleReach_mm, 1e-9);
  EXPECT_NEAR(pass.end, one.out.close_end + kPoleReach_mm, 1e-9);
  EXPECT_NEAR(pass.known_end, one.out.close_end + 2 * kPoleReach_mm, 1e-9);
  EXPECT_EQ(pass.at_begin, PoleJoin::kExact);
  EXPECT_EQ(pass.at_end, PoleJoin::kExact);
  EXPECT_EQ(pass.branch, 1);
  EXPECT_EQ(one.stretches.probe(), 368);
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
  EXPECT_EQ(one.stretches.probe(), 361);
  one.stretches.go_back_to(360);
  one.settled.end = 59.99;
  EXPECT_EQ(one.ask(), Answer::kFound);
  Stretched far(120, passing(0.06));
  EXPECT_FALSE(far.stretches.find_next(far.settled)) << "it turns the joint gently";
}

TEST(PoleStretches, CompareTheLastProbeWithTheEndOfThePath) {
  const PoleProbes::ProbeIndex last = 40 * PoleProbes::kProbes - 1;
  Stretched on(40, passing(0.03, 39.8)), before(40, passing(0.03, 40)),
      on_rise(40, passing(0.03, 39));
  EXPECT_TRUE(on.stretches.is_minimum(last));
  EXPECT_FALSE(before.stretches.is_minimum(last)) << "the end of the path is closer";
  EXPECT_FALSE(on_rise.stretches.is_minimum(last));
  EXPECT_FALSE(Stretched(40, passing(0.03, -1)).stretches.is_minimum(0)) << "nothing is before";
}

TEST(PoleStretches, DecideAMinimumOnceTwoReachesBehindItAreKnown) {
  Stretched one(120, passing(0.03), 62);
  while (one.ask() != Answer::kFound) one.push(1);
  EXPECT_EQ(one.next, 101U);  // 59.83 + 41 < 101
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
  Stretched after(120, passing(0.0005));
  after.settled = {70.0, true, false, true, 0};
  EXPECT_FALSE(after.stretches.find_next(after.settled));
}

TEST(PoleStretches, BeginWhereTheMachineRestsIfThePoleIsNearTheBeginOfThePath) {
  Stretched one(120, passing(0.0005, 10));
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.pass.at_begin, PoleJoin::kRest);
  EXPECT_EQ(one.out.pass.begin, 0);
  EXPECT_TRUE(one.out.has_room);
  Stretched begun(120, passing(0.0005, 10));
  begun.settled.is_begun = true;
  ASSERT_EQ(begun.ask(), Answer::kFound);
  EXPECT_EQ(begun.out.pass.at_begin, PoleJoin::kExact);
  const double close = 10 - 7 * kProbe_mm;
  EXPECT_NEAR(begun.out.pass.begin, close - 0.98 * close, 1e-9);
}

TEST(PoleStretches, EndAtRestWhereThePathEndsBesideThePole) {
  Stretched at_rest(62, passing(0.0005));  // it ends 0.008 rad off the pole
  ASSERT_EQ(at_rest.ask(), Answer::kFound);
  EXPECT_EQ(at_rest.out.pass.at_end, PoleJoin::kRest);
  EXPECT_EQ(at_rest.out.pass.end, 62);
  EXPECT_EQ(at_rest.out.pass.known_end, 62);
  Stretched exact(63, passing(0.0005));  // 0.012 rad
  ASSERT_EQ(exact.ask(), Answer::kFound);
  EXPECT_EQ(exact.out.pass.at_end, PoleJoin::kExact);
  const double close = 60 + 7 * kProbe_mm;
  EXPECT_NEAR(exact.out.pass.end, close + 0.98 * (63 - close), 1e-9);
  Stretched last(60, passing(0.0005));  // closest at its very end
  ASSERT_EQ(last.ask(), Answer::kFound);
  EXPECT_EQ(last.out.pass.end, 60);
  EXPECT_EQ(last.out.pass.at_end, PoleJoin::kRest);
}

TEST(PoleStretches, GoOnFromAStretchWhoseEndIsHeld) {
  Stretched one(120, passing(0.0005));
  one.settled = {60.1, true, true, true, 0};
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.pass.at_begin, PoleJoin::kHeld);
  EXPECT_EQ(one.out.pass.begin, 60.1);
  EXPECT_EQ(one.out.close_begin, 60.1);
  EXPECT_NEAR(one.out.close_end, 60 + 7 * kProbe_mm, 1e-9);
  Stretched far(120, passing(0.0005));  // and though nothing is close there any more
  far.settled = {90.1, true, true, true, 0};
  ASSERT_EQ(far.ask(), Answer::kFound);
  EXPECT_EQ(far.out.pass.at_begin, PoleJoin::kHeld);
  EXPECT_EQ(far.out.pass.begin, 90.1);
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
  EXPECT_EQ(one.stretches.probe(), 0);
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.first, 353);
  // Nothing is left of a path before that was close at the same place.
  Stretched longer(140, twice(0.0095));
  one.probes.begin(true);
  for (const BandSpan& span : longer.path) one.probes.push(span);
  one.stretches.begin(kTolerance_rad);
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_EQ(one.out.first, 353);
  EXPECT_NEAR(one.out.close_end, 70 + 7 * kProbe_mm, 1e-9);
  one.stretches.begin(10 * kTolerance_rad);
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.close_begin, 60 - 12.5, kProbe_mm) << "ten times as far";
}

}  // namespace
}  // namespace meridian::test::pole_stretches
