// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/lease_check.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "unit/daemon/lease_rivals.hpp"

namespace meridian::interpolator {
namespace {

using rivals::kMs, rivals::kS;

TEST(LeaseCheck, ServesAgainWhereTheOneThatItGaveWayToIsGone) {
  LeaseCheck check(2);
  check.hold(0);
  check.hear({.service_id = 1, .is_serving = true, .served_ns = 5 * kS}, kS);
  check.check(kS, true);
  EXPECT_FALSE(check.word(kS).is_serving);
  check.on_said(check.word(kS), kS);
  check.hear({.service_id = 1}, 3 * kS);
  check.check(3 * kS, true);
  EXPECT_FALSE(check.keeper(3 * kS));
  EXPECT_FALSE(check.word(3 * kS).is_serving) << "the smaller number goes first";
  check.forget(1);
  check.check(4 * kS, true);
  EXPECT_FALSE(check.keeper(4 * kS));
  EXPECT_TRUE(check.word(4 * kS).is_serving);
  EXPECT_TRUE(check.has_to_speak(4 * kS));
}

TEST(LeaseCheck, BelievesTheLeastDelayedWordOfAnotherOne) {
  LeaseCheck check(1);
  check.hold(0);
  check.hear({.service_id = 2, .is_serving = true, .served_ns = kS + 200 * kMs}, kS);
  check.hear({.service_id = 2, .is_serving = true, .served_ns = kS + 700 * kMs}, 2 * kS);
  check.check(2 * kS, true);
  EXPECT_FALSE(check.word(2 * kS).is_serving);
}

TEST(LeaseCheck, TakesNobodyForOlderWhoCannotSayForHowLongItServed) {
  for (const std::int64_t served : {INT64_MIN, std::int64_t{-1}}) {
    LeaseCheck check(1);
    check.hold(0);
    check.hear({.service_id = 2, .is_serving = true, .served_ns = served}, 10 * kS);
    check.check(10 * kS, true);
    EXPECT_TRUE(check.word(10 * kS).is_serving) << served;
  }
}

TEST(LeaseCheck, TakesWhoServedAlmostAsLongForOneOfTheSameAge) {
  for (const std::int64_t lead : {-LeaseCheck::kSame_ns, LeaseCheck::kSame_ns - 1}) {
    for (const std::uint64_t own : {1U, 3U}) {
      LeaseCheck check(own);
      check.hold(0);
      check.hear({.service_id = 2, .is_serving = true, .served_ns = kS - lead}, kS);
      check.check(kS, true);
      EXPECT_EQ(check.word(kS).is_serving, own < 2) << lead;
    }
  }
}

TEST(LeaseCheck, LeavesNoMachineWhoseDrivesObeyItWhateverOthersClaim) {
  LeaseCheck check(7);
  check.hold(0);
  for (std::int64_t now = kS; now < 20 * kS; now += 100 * kMs) {
    EXPECT_TRUE(check.hear({.service_id = 1, .is_serving = true, .served_ns = 9000 * kS}, now));
    check.check(now, true, 7);
    check.on_said(check.word(now), now);
    ASSERT_TRUE(check.word(now).is_serving) << now;
    ASSERT_FALSE(check.keeper(now)) << now;
  }
}

TEST(LeaseCheck, GivesWayToAYoungerOneThatTheDrivesObeyIfThatServes) {
  for (const bool is_serving : {true, false}) {
    LeaseCheck check(1);
    check.hold(0);
    check.hear({.service_id = 2, .is_serving = is_serving, .served_ns = kS}, 100 * kS);
    check.check(100 * kS, true, 2);
    EXPECT_EQ(check.word(100 * kS).is_serving, !is_serving);
  }
}

TEST(LeaseCheck, ServesAgainAsSoonAsTheDrivesObeyIt) {
  LeaseCheck check(7);
  check.hold(0);
  check.hear({.service_id = 1, .is_serving = true, .served_ns = 9000 * kS}, kS);
  check.check(kS, true);
  check.on_said(check.word(kS), kS);
  EXPECT_FALSE(check.word(kS).is_serving);
  check.check(2 * kS, true, 7);
  EXPECT_TRUE(check.word(2 * kS).is_serving);
  EXPECT_FALSE(check.keeper(10 * kS));
}

TEST(LeaseCheck, LeavesTheMachineToTheOneThatTheDrivesObeyWhoeverServedLonger) {
  for (const std::uint64_t obeyed : {1U, 2U}) {
    LeaseCheck one(1), two(2);
    one.hold(0);
    two.hold(60 * kS);
    std::int64_t now = 100 * kS;
    std::optional<std::uint64_t> left_by_one, left_by_two;
    for (; now < 110 * kS && !left_by_one && !left_by_two; now += 100 * kMs) {
      one.hear(two.word(now), now);
      two.hear(one.word(now), now);
      for (LeaseCheck* const check : {&one, &two}) {
        check->check(now, true, obeyed);
        check->on_said(check->word(now), now);
      }
      left_by_one = one.keeper(now);
      left_by_two = two.keeper(now);
    }
    EXPECT_EQ(left_by_one.has_value(), obeyed == 2);
    EXPECT_EQ(left_by_two.has_value(), obeyed == 1);
  }
}

TEST(LeaseCheck, HearsNothingThatNobodyCanHaveServedNorMoreOthersThanThereAreServices) {
  LeaseCheck check(1000);
  check.hold(0);
  EXPECT_FALSE(check.hear({.service_id = 1, .is_serving = true, .served_ns = INT64_MAX}, kS));
  EXPECT_FALSE(check.hear({.service_id = 1, .is_serving = true, .served_ns = 1LL << 60U}, kS));
  EXPECT_FALSE(check.hear({.service_id = 0, .is_serving = true, .served_ns = kS}, kS));
  std::size_t heard = 0;
  for (std::uint64_t id = 1; id < 1000; ++id) {
    heard += check.hear({.service_id = id, .is_serving = false}, kS) ? 1U : 0U;
  }
  EXPECT_EQ(heard, LeaseCheck::kMaxOthers);
}

TEST(LeaseCheck, GivesNoWayToWhoServesNoMore) {
  LeaseCheck check(3);
  check.hold(0);
  check.hear({.service_id = 2, .is_serving = true, .served_ns = 9 * kS}, kS);
  check.hear({.service_id = 2}, kS);
  check.check(kS, true);
  EXPECT_TRUE(check.word(kS).is_serving);
}

/// An hour of doubt about another one, whose words are late, is none about the next.
TEST(LeaseCheck, WaitsAnewForWordsThatDecideWhereverAnotherOneBeginsToServeBesideIt) {
  LeaseCheck check(2);
  check.hold(0);
  const auto late = [](std::int64_t now) {
    return LeaseCheck::Word{.service_id = 1, .is_serving = true, .served_ns = now - kS};
  };
  check.hear({.service_id = 1}, kS);
  check.check(3600 * kS, true);
  check.hear(late(3600 * kS), 3600 * kS);
  check.check(3600 * kS, true);
  EXPECT_TRUE(check.word(3600 * kS).is_serving) << "it may be the later one";
  const std::int64_t over = 3600 * kS + LeaseCheck::kPatience_ns + 1;
  check.check(over, true);
  EXPECT_FALSE(check.word(over).is_serving);
}

TEST(LeaseCheck, LeavesOnlyAsLongBehindItsLastStepBackAsItsWordNeeds) {
  LeaseCheck check(2);
  check.hold(0);
  const auto step_back = [&](std::int64_t now) {
    check.hear({.service_id = 1, .is_serving = true, .served_ns = now + kS}, now);
    check.check(now, true);
    check.on_said(check.word(now), now);
  };
  step_back(kS);
  check.check(2 * kS, false);  // it moves meanwhile: it serves on
  EXPECT_TRUE(check.word(2 * kS).is_serving);
  step_back(10 * kS);
  const std::int64_t last = 10 * kS + LeaseCheck::kStepBack_ns;
  EXPECT_FALSE(check.keeper(last - 1));
  check.on_said(check.word(last - 1), last - 1);  // said again, twice a second
  EXPECT_EQ(check.keeper(last), 1U);
}

TEST(LeaseCheck, SaysNothingAnewWhereItServesAlone) {
  LeaseCheck check(1);
  check.hold(0);
  check.on_said(check.word(0), 0);
  check.hear({.service_id = 2}, kS);
  check.check(10 * kS, true);
  EXPECT_FALSE(check.has_to_speak(10 * kS));
  check.hear({.service_id = 2, .is_serving = true}, 11 * kS);
  EXPECT_TRUE(check.has_to_speak(11 * kS));
}

}  // namespace
}  // namespace meridian::interpolator
