// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/feed_raise.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/machines.hpp"

namespace meridian::test::feed_raise {
namespace {

/// 200 % at most, over which the override takes 2 s.
MachineModel machine() {
  MachineModel model = bench_machine();
  model.max_feed_override = 2;
  model.override_ramp_s = 2;
  return model;
}

void expect_factors(const FeedFactors& got, double label, double planned) {
  EXPECT_DOUBLE_EQ(got.label, label);
  EXPECT_DOUBLE_EQ(got.planned, planned);
}

std::vector<FeedMark> marks_of(FeedRaise& raise) {
  std::vector<FeedMark> out;
  for (FeedMark mark; raise.take(mark);) out.push_back(mark);
  return out;
}

TEST(FeedRaise, IsNothingOnAMachineThatHasNone) {
  MachineModel model = machine();
  model.max_feed_override = 1;
  FeedRaise raise(model);
  raise.begin(100);
  expect_factors(raise.next(1, 1.5, 0.1), 1, 1);
  EXPECT_EQ(marks_of(raise).size(), 1U) << "that the program began";
}

TEST(FeedRaise, IsInForceAtOnceWhereTheMachineRests) {
  FeedRaise raise(machine());
  raise.begin(100);
  expect_factors(raise.next(1, 1.5, 0.1), 1.5, 1.5);
  raise.rest();
  expect_factors(raise.next(1, 2, 0.1), 2, 2);
}

TEST(FeedRaise, LabelsTheWayToAHigherFeedSoEarlyThatTheRateCanFollow) {
  FeedRaise raise(machine());
  raise.begin(100);
  expect_factors(raise.next(1, 1, 0.1), 1, 1);
  // 2 s of ramp by 1 - 1/2, and 0.3 s to settle: 1.3 s of stretches at 100 %.
  double passed = 0;
  FeedFactors got = raise.next(1, 2, 0.25);
  while (got.planned < 2) {
    expect_factors(got, 2, 1);
    passed += 0.25;
    got = raise.next(1, 2, 0.25);
    ASSERT_LT(passed, 10);
  }
  EXPECT_DOUBLE_EQ(passed, 1.5) << "six stretches, the first that reach over 1.3 s";
  expect_factors(got, 2, 2);
}

TEST(FeedRaise, CountsTheTimeOfAStretchAtTheFeedThatIsPlanned) {
  FeedRaise raise(machine());
  raise.begin(100);
  expect_factors(raise.next(1, 1.25, 0.1), 1.25, 1.25);
  // 2 (1 - 1.25/2) + 0.3 = 1.05 s; stretches of 0.5 s take 0.4 s.
  for (int n = 0; n < 3; ++n) expect_factors(raise.next(1, 2, 0.5), 2, 1.25);
  expect_factors(raise.next(1, 2, 0.5), 2, 2);
}

TEST(FeedRaise, FallsAtOnceAndGoesOnFromThere) {
  FeedRaise raise(machine());
  raise.begin(100);
  expect_factors(raise.next(1, 2, 0.1), 2, 2);
  expect_factors(raise.next(1, 1.2, 0.1), 1.2, 1.2);
  expect_factors(raise.next(1, 2, 0.1), 2, 1.2);
  expect_factors(raise.next(1, 1.1, 0.1), 1.1, 1.1);
  raise.begin(100);
  expect_factors(raise.next(1, 1, 0.1), 1, 1);
}

TEST(FeedRaise, IsNeverBelow100PercentNorAboveWhatTheMachineAllows) {
  FeedRaise raise(machine());
  raise.begin(100);
  expect_factors(raise.next(1, 0.3, 0.1), 1, 1);
  raise.rest();
  expect_factors(raise.next(1, 7, 0.1), 2, 2);
}

TEST(FeedRaise, ReportsWhereAFactorChanges) {
  FeedRaise raise(machine());
  raise.begin(123);
  (void)raise.next(4, 1, 0.1);
  (void)raise.next(4, 1.5, 0.1);
  (void)raise.next(4, 1.5, 0.1);
  FeedMark look;
  look.looked_at = 77;
  raise.note_look(look);
  (void)raise.next(3, 1.25, 0.1);  // a block that began earlier: of the same count
  (void)raise.next(5, 2, 0.1);
  const auto marks = marks_of(raise);
  ASSERT_EQ(marks.size(), 5U);
  EXPECT_TRUE(marks[0].is_begin);
  EXPECT_EQ(marks[0].tool_length_mm, 123);
  EXPECT_FALSE(marks[1].is_begin);
  EXPECT_EQ(marks[1].sequence, 4U);
  EXPECT_EQ(marks[1].span, 1U);
  EXPECT_EQ(marks[1].factor, 1.5);
  EXPECT_EQ(marks[2].looked_at, 77U);
  EXPECT_EQ(marks[3].sequence, 4U);
  EXPECT_EQ(marks[3].span, 3U);
  EXPECT_EQ(marks[4].sequence, 5U);
  EXPECT_EQ(marks[4].span, 0U);
}

TEST(FeedRaise, KeepsTheNewestMarksWhereNobodyTakesThem) {
  FeedRaise raise(machine());
  raise.begin(100);
  for (int n = 0; n < 400; ++n) (void)raise.next(1, n % 2 == 0 ? 1.5 : 1, 0.1);
  const auto marks = marks_of(raise);
  ASSERT_EQ(marks.size(), 256U);
  EXPECT_EQ(marks.back().span, 399U);
}

/// Factors of ten blocks of three stretches each; what is asked for changes within them.
std::vector<FeedFactors> run(FeedRaise& raise, double asked_at_first) {
  raise.begin(100);
  std::vector<FeedFactors> out;
  for (int n = 0; n < 30; ++n) {
    const double asked = n < 4 ? asked_at_first : n < 17 ? 2.0 : 1.25;
    out.push_back(raise.next(static_cast<std::uint64_t>(n / 3), asked, 0.2));
  }
  return out;
}

TEST(FeedRaise, ReplaysTheFactorsOfARunBefore) {
  FeedRaise first(machine()), again(machine());
  const auto factors = run(first, 1);
  auto marks = marks_of(first);
  FeedMark look;
  look.looked_at = 5;
  look.factor = 1.9;
  marks.insert(marks.begin() + 2, look);  // it says nothing of the feed
  marks.erase(marks.begin());             // it begins at 100 % without being told
  again.replay(marks);
  again.note_look(look);
  for (int round = 0; round < 2; ++round) {
    const auto replayed = run(again, 1.75);
    for (std::size_t n = 0; n < factors.size(); ++n) {
      EXPECT_EQ(replayed[n].label, factors[n].label) << n;
      EXPECT_EQ(replayed[n].planned, factors[n].planned) << n;
    }
  }
  EXPECT_TRUE(marks_of(again).empty()) << "a replay reports nothing";
}

}  // namespace
}  // namespace meridian::test::feed_raise
