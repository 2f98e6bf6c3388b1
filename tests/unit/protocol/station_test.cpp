// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/station.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "support/programs.hpp"

namespace meridian::stream {
namespace {

using dds::Verdict;

constexpr std::int64_t kSecond = 1'000'000'000;

/// Hands out `count` good cuts, then the end.
Source cuts(std::uint64_t count) {
  return [count, next = std::uint64_t{0}]() mutable -> Supply {
    if (next == count) return {.kind = Supply::Kind::kEnd};
    return {.kind = Supply::Kind::kBlock, .block = test::good_cut(next++)};
  };
}

dds::Credit credit(std::uint64_t next, std::uint32_t credits, Verdict verdict = Verdict::kGood,
                   const std::string& text = {}) {
  dds::Credit answer;
  answer.session = 5;
  answer.service_id = 9;
  answer.next_sequence = next;
  answer.credits = credits;
  answer.verdict = verdict;
  answer.text = text;
  return answer;
}

Station opened(std::uint64_t count, std::uint32_t credits) {
  Station station({.session = 5, .station = "cam-1", .program = "part.cls"}, cuts(count));
  static_cast<void>(station.due_request(0));
  station.on_credit(credit(0, credits), 0);
  return station;
}

TEST(StationProtocol, AsksUntilSomebodyAnswersOrTimeIsUp) {
  Station station({.session = 5}, cuts(1));
  EXPECT_TRUE(station.due_request(0));
  EXPECT_FALSE(station.due_request(kSecond / 4));
  EXPECT_TRUE(station.due_request(kSecond / 2));
  EXPECT_FALSE(station.due_request(5 * kSecond));
  EXPECT_EQ(station.state(), StationState::kNoAnswer);
}

TEST(StationProtocol, SendsNothingBeforeTheAnswer) {
  Station station({.session = 5}, cuts(1));
  dds::Batch batch;
  EXPECT_FALSE(station.next_batch(0, batch));
}

TEST(StationProtocol, SendsWholeBatchesAsFarAsCreditsReach) {
  Station station = opened(1000, 70);
  dds::Batch batch;
  ASSERT_TRUE(station.next_batch(0, batch));
  EXPECT_EQ(batch.count, 32u);
  EXPECT_EQ(batch.crc, dds::batch_crc(batch));
  ASSERT_TRUE(station.next_batch(0, batch));
  EXPECT_EQ(batch.first_sequence, 32u);
  EXPECT_FALSE(station.next_batch(0, batch)) << "six credits wait for more";
  station.on_credit(credit(64, 6), 0);
  ASSERT_TRUE(station.next_batch(0, batch)) << "nothing under way could bring more";
  EXPECT_EQ(batch.count, 6u);
}

TEST(StationProtocol, MarksTheEndOnTheLastBatch) {
  Station station = opened(40, 100);
  dds::Batch batch;
  ASSERT_TRUE(station.next_batch(0, batch));
  EXPECT_FALSE(batch.is_end);
  ASSERT_TRUE(station.next_batch(0, batch));
  EXPECT_EQ(batch.count, 8u);
  EXPECT_TRUE(batch.is_end);
  EXPECT_FALSE(station.next_batch(0, batch));
  station.on_credit(credit(40, 0, Verdict::kComplete), 0);
  EXPECT_EQ(station.state(), StationState::kComplete);
}

TEST(StationProtocol, GoesBackToTheGapOnceAndAgainOnlyAfterAWhile) {
  Station station = opened(1000, 1000);
  dds::Batch batch;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(station.next_batch(0, batch));
  station.on_credit(credit(32, 900, Verdict::kGap), 1000);
  ASSERT_TRUE(station.next_batch(1000, batch));
  EXPECT_EQ(batch.first_sequence, 32u);
  station.on_credit(credit(32, 900, Verdict::kGap), 2000);
  ASSERT_TRUE(station.next_batch(2000, batch));
  EXPECT_EQ(batch.first_sequence, 64u) << "the same gap, reported twice";
  constexpr std::int64_t kLater = kSecond / 10;
  station.on_credit(credit(32, 900, Verdict::kGap), kLater);
  ASSERT_TRUE(station.next_batch(kLater, batch));
  EXPECT_EQ(batch.first_sequence, 32u) << "the resend was lost too";
  EXPECT_EQ(station.progress().resends, 2u);
}

TEST(StationProtocol, SkipsWhatWasAcknowledgedAfterItWentBack) {
  Station station = opened(1000, 1000);
  dds::Batch batch;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(station.next_batch(0, batch));
  station.on_credit(credit(32, 900, Verdict::kGap), 1000);
  station.on_credit(credit(96, 900), 1000);  // the batches had only been overtaken
  ASSERT_TRUE(station.next_batch(1000, batch));
  EXPECT_EQ(batch.first_sequence, 96u);
}

TEST(StationProtocol, SendsAgainWhenTheServiceStaysSilent) {
  Station station = opened(10, 100);
  dds::Batch batch;
  ASSERT_TRUE(station.next_batch(0, batch));
  EXPECT_FALSE(station.next_batch(kSecond / 4, batch));
  ASSERT_TRUE(station.next_batch(kSecond, batch));
  EXPECT_EQ(batch.first_sequence, 0u);
  EXPECT_TRUE(batch.is_end);
}

TEST(StationProtocol, ABatchThatCouldNotBeWrittenIsDueAgain) {
  Station station = opened(100, 100);
  dds::Batch batch;
  ASSERT_TRUE(station.next_batch(0, batch));
  station.on_not_sent();
  ASSERT_TRUE(station.next_batch(0, batch));
  EXPECT_EQ(batch.first_sequence, 0u);
}

TEST(StationProtocol, StopsWithTheServicesWordsWhenRefused) {
  Station station = opened(100, 100);
  station.on_credit(credit(0, 0, Verdict::kRefusedBlock, "line 13, block 3: no"), 0);
  EXPECT_EQ(station.state(), StationState::kRefused);
  EXPECT_EQ(station.message(), "line 13, block 3: no");
  dds::Batch batch;
  EXPECT_FALSE(station.next_batch(0, batch));
}

TEST(StationProtocol, ARestartedServiceHasLostTheSession) {
  Station station = opened(100, 100);
  dds::Credit other = credit(0, 100);
  other.service_id = 10;
  station.on_credit(other, 0);
  EXPECT_EQ(station.state(), StationState::kRefused);
}

TEST(StationProtocol, AsksAgainWhenTheServiceFellSilentAndThereIsNothingToSend) {
  Station station = opened(1000, 32);
  dds::Batch batch;
  ASSERT_TRUE(station.next_batch(0, batch));
  station.on_credit(credit(32, 0), kSecond);
  EXPECT_FALSE(station.next_batch(9 * kSecond, batch)) << "no credit, nothing under way";
  EXPECT_FALSE(station.due_request(2 * kSecond - 1));
  EXPECT_TRUE(station.due_request(2 * kSecond));
  EXPECT_FALSE(station.due_request(2 * kSecond)) << "once a while";
  EXPECT_TRUE(station.due_request(3 * kSecond));
}

TEST(StationProtocol, SendsNothingAfterItAskedAgainUntilItIsAnswered) {
  Station station = opened(1000, 100);
  ASSERT_TRUE(station.due_request(kSecond)) << "the service fell silent, or was restarted";
  dds::Batch batch;
  EXPECT_FALSE(station.next_batch(kSecond, batch)) << "a new service would keep the head";
  station.on_credit(credit(0, 100), kSecond);
  ASSERT_TRUE(station.next_batch(kSecond, batch));
  EXPECT_EQ(batch.first_sequence, 0u);
}

TEST(StationProtocol, IgnoresCreditsOfOtherSessions) {
  Station station = opened(100, 0);
  dds::Credit other = credit(0, 100);
  other.session = 6;
  station.on_credit(other, 0);
  dds::Batch batch;
  EXPECT_FALSE(station.next_batch(0, batch));
}

TEST(StationProtocol, ABadSourceStopsTheStation) {
  Station station({.session = 5},
                  [] { return Supply{.kind = Supply::Kind::kBad, .text = "line 1: what?"}; });
  static_cast<void>(station.due_request(0));
  station.on_credit(credit(0, 100), 0);
  dds::Batch batch;
  EXPECT_FALSE(station.next_batch(0, batch));
  EXPECT_EQ(station.state(), StationState::kBadSource);
  EXPECT_EQ(station.message(), "line 1: what?");
}

TEST(StationProtocol, WaitsForASourceThatHasNothingNow) {
  int calls = 0;
  Station station({.session = 5}, [&calls]() -> Supply {
    if (++calls % 2 != 0) return {.kind = Supply::Kind::kWait};
    return {.kind = Supply::Kind::kBlock, .block = test::good_cut(0)};
  });
  static_cast<void>(station.due_request(0));
  station.on_credit(credit(0, 1), 0);
  dds::Batch batch;
  EXPECT_FALSE(station.next_batch(0, batch));
  EXPECT_FALSE(station.is_gathering());
  EXPECT_FALSE(station.next_batch(0, batch));
  EXPECT_TRUE(station.is_gathering());
  ASSERT_TRUE(station.next_batch(StationOptions{}.gather_ns, batch));
  EXPECT_EQ(batch.count, 1u);
}

/// A source that has had `there` blocks so far and waits for more.
struct SlowSource {
  std::uint64_t there = 0, given = 0;
  Supply operator()() {
    if (given == there) return {.kind = Supply::Kind::kWait};
    return {.kind = Supply::Kind::kBlock, .block = test::good_cut(given++)};
  }
};

TEST(StationProtocol, HoldsASmallBatchOfASlowSourceBackForAFewMillisecondsOnly) {
  SlowSource source;
  Station station({.session = 5}, [&source] { return source(); });
  static_cast<void>(station.due_request(0));
  station.on_credit(credit(0, 1000), 0);
  constexpr std::int64_t kGather = StationOptions{}.gather_ns;
  dds::Batch batch;
  source.there = 3;
  EXPECT_FALSE(station.next_batch(0, batch));
  source.there = 5;
  EXPECT_FALSE(station.next_batch(kGather - 1, batch));
  ASSERT_TRUE(station.next_batch(kGather, batch)) << "so long after the first of them";
  EXPECT_EQ(batch.count, 5u);
  EXPECT_FALSE(station.is_gathering());
  source.there = 5 + 40;
  ASSERT_TRUE(station.next_batch(2 * kGather, batch)) << "a whole batch waits for nothing";
  EXPECT_EQ(batch.count, 32u);
  EXPECT_FALSE(station.next_batch(2 * kGather, batch));
  ASSERT_TRUE(station.next_batch(3 * kGather, batch));
  EXPECT_EQ(batch.count, 8u);
}

}  // namespace
}  // namespace meridian::stream
