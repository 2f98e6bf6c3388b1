// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/freshness.hpp"

#include <gtest/gtest.h>

namespace meridian::stream {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::uint64_t kService = 77;

class Freshness : public testing::Test {
 protected:
  Freshness() {
    for (std::uint64_t i = 1; i <= 1000; ++i) {
      times_.published(i, static_cast<std::int64_t>(i) * 10 * kMillisecond);
    }
  }
  /// Verdict at 10 s, right after status 1000.
  Refusal at_10_s(Verb verb, std::uint64_t status_seen, std::uint16_t epoch_seen = 3,
                  std::uint64_t service_seen = kService) {
    dds::CommandRequest request;
    request.verb = verb;
    request.status_seen = status_seen;
    request.epoch_seen = epoch_seen;
    request.service_id_seen = service_seen;
    return check_freshness(request, kService, 3, times_, 10'000 * kMillisecond);
  }
  StatusTimes times_;
};

TEST_F(Freshness, AcceptsAStatusOf500Milliseconds) {
  EXPECT_EQ(at_10_s(Verb::kStart, 1000), Refusal::kNone);
  EXPECT_EQ(at_10_s(Verb::kStart, 950), Refusal::kNone);
}

TEST_F(Freshness, RefusesAnOlderStatus) {
  EXPECT_EQ(at_10_s(Verb::kStart, 949), Refusal::kStale);
  EXPECT_EQ(at_10_s(Verb::kResume, 1), Refusal::kStale);
}

TEST_F(Freshness, RefusesAStatusThatWasNeverPublished) {
  EXPECT_EQ(at_10_s(Verb::kStart, 1001), Refusal::kStale);
  EXPECT_EQ(at_10_s(Verb::kStart, 0), Refusal::kStale);
  EXPECT_EQ(at_10_s(Verb::kStart, ~std::uint64_t{0}), Refusal::kStale);
}

TEST_F(Freshness, KnowsForHowLongThereHasBeenANewerStatus) {
  constexpr std::int64_t kNow = 10'004 * kMillisecond;  // status 1000 was published at 10'000
  const auto age = [this](std::uint64_t sequence, std::int64_t now_ns) {
    return times_.superseded_for(sequence, now_ns, 10 * kMillisecond);
  };
  EXPECT_EQ(age(1000, kNow), 0);
  EXPECT_EQ(age(1000, kNow + 16 * kMillisecond), 0) << "the next is late, as they are on a host";
  EXPECT_EQ(age(1000, kNow + 86 * kMillisecond), 70 * kMillisecond) << "nobody publishes any more";
  EXPECT_EQ(age(999, kNow), 4 * kMillisecond);
  EXPECT_EQ(age(990, kNow), 94 * kMillisecond);
  EXPECT_EQ(times_.superseded_for(999, kNow, kMillisecond), 12 * kMillisecond) << "came too late";
  EXPECT_EQ(age(1001, kNow), std::nullopt) << "of the future";
  EXPECT_EQ(age(400, kNow), std::nullopt) << "forgotten";
  EXPECT_EQ(StatusTimes().superseded_for(0, kNow, 10 * kMillisecond), std::nullopt);
}

TEST_F(Freshness, RefusesAnOldEpochAndAnotherService) {
  EXPECT_EQ(at_10_s(Verb::kStart, 1000, 2), Refusal::kStale);
  EXPECT_EQ(at_10_s(Verb::kStart, 1000, 3, kService + 1), Refusal::kStale);
}

TEST_F(Freshness, VerbsThatOnlyStopAreNeverStale) {
  for (const Verb verb : {Verb::kHold, Verb::kAbort, Verb::kDisable, Verb::kReset}) {
    EXPECT_EQ(at_10_s(verb, 0, 0, 0), Refusal::kNone);
  }
}

TEST_F(Freshness, VerbsThatMoveOrSpeedUpAreChecked) {
  for (const Verb verb :
       {Verb::kEnable, Verb::kStart, Verb::kResume, Verb::kFeedOverride, Verb::kRapidOverride,
        Verb::kSingleBlock, Verb::kOptionalStop, Verb::kDryRun}) {
    EXPECT_EQ(at_10_s(verb, 1), Refusal::kStale);
  }
}

TEST(FreshnessOfSwitches, OnIsNeverStale) {
  for (const Verb verb : {Verb::kSingleBlock, Verb::kOptionalStop, Verb::kDryRun}) {
    EXPECT_FALSE(needs_freshness(verb, 1));
    EXPECT_TRUE(needs_freshness(verb, 0));
  }
}

TEST(FreshnessOfRests, StartAndResumeThatQuoteOneStatusSendOnOnce) {
  StatusTimes times;
  times.published(5, 0, rest_of(State::kStepping, 7));
  times.published(6, 1, rest_of(State::kRunning, 8));
  for (const Verb verb : {Verb::kStart, Verb::kResume}) {
    dds::CommandRequest request;
    request.verb = verb;
    request.epoch_seen = 1;
    const auto checked = [&](std::uint64_t seen, State state, std::uint64_t block) {
      request.status_seen = seen;
      return check_freshness(request, 1, 1, times, 2, rest_of(state, block));
    };
    EXPECT_EQ(checked(5, State::kStepping, 7), Refusal::kNone);
    EXPECT_EQ(checked(5, State::kStepping, 8), Refusal::kStale);
    EXPECT_EQ(checked(6, State::kStepping, 8), Refusal::kStale);
    EXPECT_EQ(checked(6, State::kHeld, 8), Refusal::kNone);
  }
}

}  // namespace
}  // namespace meridian::stream
