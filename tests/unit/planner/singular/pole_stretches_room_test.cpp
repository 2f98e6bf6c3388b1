// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_stretches.hpp"

/// Stretches that are long or near one another, and what room is beside them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/planner/singular/stretched_path.hpp"

namespace meridian::test::pole_stretches {
namespace {

/// All of it close to the pole; closest at u = 30.
auto along(double u) { return Lean{0.001 + 2e-5 * std::abs(u - 30), 0.0005}; }

TEST(PoleStretches, GoOnBehindAPlaceOfAStretchThatIsLong) {
  Stretched one(300, along, 10);
  while (one.ask() != Answer::kFound) {
    one.push(1);
    ASSERT_LT(one.next, 300U);
  }
  EXPECT_EQ(one.next, 81U) << "four reaches, and the span whose last probe waits for the next";
  const PolePass& pass = one.out.pass;
  EXPECT_EQ(pass.at_begin, PoleJoin::kRest);
  EXPECT_EQ(pass.at_end, PoleJoin::kHeld);
  EXPECT_NEAR(pass.end, 30, 1e-9) << "where it is closest, well ahead of what is known";
  EXPECT_EQ(one.out.last, 180);
  EXPECT_GT(pass.seen_end, 80 - 1e-9);
  EXPECT_EQ(pass.known_end, pass.seen_end);
  EXPECT_TRUE(one.out.has_room);
  EXPECT_EQ(one.stretches.probe(), 181);
}

TEST(PoleStretches, CountALongStretchFromItsBegin) {
  // From u = 30 on it stays close.
  Stretched one(
      300,
      [](double u) {
        return Lean{0.001 + 0.004 * std::max(0.0, 30 - u), 0};
      },
      10);
  while (one.ask() != Answer::kFound) {
    one.push(1);
    ASSERT_LT(one.next, 300U);
  }
  EXPECT_NEAR(one.out.close_begin, 29, kProbe_mm + 1e-9);
  EXPECT_NEAR(one.out.pass.seen_end, one.out.close_begin + 80, 1 + kProbe_mm);
  EXPECT_EQ(one.out.pass.at_end, PoleJoin::kHeld);
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
  EXPECT_NEAR(one.out.pass.end, end + 0.49 * (other - end), 1e-9);
  one.settled.is_begun = true;
  one.settled.end = one.out.pass.end;
  ASSERT_EQ(one.ask(), Answer::kFound);
  EXPECT_NEAR(one.out.close_begin, other, 1e-9);
  EXPECT_NEAR(one.out.pass.begin, other - 0.98 * (other - one.settled.end), 1e-9);
}

TEST(PoleStretches, CanBeShortenedWhereTheExactWayLeadsThere) {
  Stretched one(120, passing(0.0005));
  ASSERT_EQ(one.ask(), Answer::kFound);
  PoleStretch both = one.out, none = one.out, snapped = one.out, rest = one.out, held = one.out;
  EXPECT_TRUE(one.stretches.shorten(both, 5));
  EXPECT_NEAR(both.pass.begin, both.close_begin - 5, 1e-9);
  EXPECT_NEAR(both.pass.end, both.close_end + 5, 1e-9);
  EXPECT_FALSE(one.stretches.shorten(none, 30));
  EXPECT_EQ(none.pass.begin, one.out.pass.begin);
  EXPECT_EQ(none.pass.end, one.out.pass.end);
  // No part of a span that is shorter than 0.1 µm is left over.
  EXPECT_TRUE(one.stretches.shorten(snapped, 5 * kProbe_mm + 5e-5));
  EXPECT_EQ(snapped.pass.begin, 58);
  EXPECT_EQ(snapped.pass.end, 62);
  rest.pass.at_begin = rest.pass.at_end = PoleJoin::kRest;
  EXPECT_TRUE(one.stretches.shorten(rest, 5));
  EXPECT_EQ(rest.pass.at_begin, PoleJoin::kExact);
  EXPECT_EQ(rest.pass.end, one.out.pass.end) << "a rest at the end stays";
  held.pass.at_begin = PoleJoin::kHeld;
  EXPECT_TRUE(one.stretches.shorten(held, 5));
  EXPECT_EQ(held.pass.begin, one.out.pass.begin);
  held = one.out;
  held.pass.at_begin = held.pass.at_end = PoleJoin::kHeld;
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

TEST(PoleStretches, AreDecidedAfreshWhateverWasThereBefore) {
  Stretched fresh(120, passing(0.0005)), again(120, passing(0.0005));
  again.out.pass.at_begin = PoleJoin::kHeld;
  again.out.pass.at_end = PoleJoin::kRest;
  again.out.pass.seen_end = 7;
  again.out.pass.rate = 3;
  again.out.pass.exact = ExactPath::kMeetsPole;
  ASSERT_EQ(fresh.ask(), Answer::kFound);
  ASSERT_EQ(again.ask(), Answer::kFound);
  EXPECT_EQ(again.out.pass.at_begin, PoleJoin::kExact);
  EXPECT_EQ(again.out.pass.at_end, PoleJoin::kExact);
  EXPECT_EQ(again.out.pass.seen_end, fresh.out.pass.seen_end);
  EXPECT_EQ(again.out.pass.rate, 0);
  EXPECT_EQ(again.out.pass.exact, ExactPath::kLeadsOn);
  EXPECT_EQ(again.out.pass.end, fresh.out.pass.end);
}

}  // namespace
}  // namespace meridian::test::pole_stretches
