// SPDX-License-Identifier: Apache-2.0

/// What intake makes of batches, and how many it asks for.

#include <string>

#include "intake_under_test.hpp"

namespace meridian::stream {
namespace {

TEST_F(Intake, GrantsTheFreePlacesButOneForTheEnd) {
  const Credit credit = open();
  EXPECT_EQ(credit.session, kSession);
  EXPECT_EQ(credit.service_id, 99u);
  EXPECT_EQ(credit.verdict, Verdict::kGood);
  EXPECT_EQ(credit.next_sequence, 0u);
  EXPECT_EQ(credit.credits, 99u);
}

TEST_F(Intake, TakesBlocksInOrder) {
  static_cast<void>(open());
  EXPECT_FALSE(send(good_batch(kSession, 0, 32)));
  EXPECT_EQ(accepted_.count, 32u);
  EXPECT_FALSE(send(good_batch(kSession, 32, 5)));
  EXPECT_EQ(accepted_.count, 5u);
  EXPECT_EQ(accepted_.blocks[4].sequence, 36u);
  EXPECT_EQ(check_.next_sequence(), 37u);
}

/// Whose length its plan would go by nobody knows.
TEST_F(Intake, TakesNoProgramWhileAnAbortedToolChangeIsNotAnswered) {
  around_.is_tool_known = false;
  const Credit refused = open();
  EXPECT_EQ(refused.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(refused.text.find("which tool is in the spindle is not known"), std::string::npos);
  EXPECT_EQ(check_.session(), 0U);
  around_.is_tool_known = true;
  EXPECT_EQ(open(kSession + 1).verdict, Verdict::kGood);
  around_.is_tool_known = false;  // by this program's own change
  EXPECT_EQ(open(kSession + 1).verdict, Verdict::kGood) << "it goes on";
}

TEST_F(Intake, RefusesASecondStationByName) {
  static_cast<void>(open());
  const Credit answer = open(0xdef, "cam-2");
  EXPECT_EQ(answer.session, 0xdefu);
  EXPECT_EQ(answer.verdict, Verdict::kRefusedStation);
  EXPECT_NE(answer.text.find("held by station cam-1 with program part.cls"), std::string::npos)
      << answer.text;
  EXPECT_EQ(check_.session(), kSession);
}

TEST_F(Intake, OpenTwiceIsAnsweredTwice) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 8)));
  const Credit again = open();
  EXPECT_EQ(again.verdict, Verdict::kGood);
  EXPECT_EQ(again.next_sequence, 8u);
}

TEST_F(Intake, DropsADuplicate) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  EXPECT_FALSE(send(good_batch(kSession, 0, 10)));
  EXPECT_EQ(accepted_.count, 0u);
  EXPECT_EQ(check_.counters().batches_duplicate, 1u);
}

TEST_F(Intake, TakesOnlyTheNewPartOfAnOverlap) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  EXPECT_FALSE(send(good_batch(kSession, 4, 10)));
  EXPECT_EQ(accepted_.count, 4u);
  EXPECT_EQ(accepted_.blocks[0].sequence, 10u);
}

TEST_F(Intake, AsksAgainFromTheLastGoodSequenceAfterAGap) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  const auto answer = send(good_batch(kSession, 20, 10));
  ASSERT_TRUE(answer);
  EXPECT_EQ(accepted_.count, 0u);
  EXPECT_EQ(answer->verdict, Verdict::kGap);
  EXPECT_EQ(answer->next_sequence, 10u);
  EXPECT_EQ(answer->text, "blocks 10 to 19 are missing: send again");
  const auto healed = send(good_batch(kSession, 10, 10));
  ASSERT_TRUE(healed);
  EXPECT_EQ(healed->verdict, Verdict::kGood);
  EXPECT_EQ(healed->next_sequence, 20u);
}

TEST_F(Intake, ABadCrcCountsAsLost) {
  static_cast<void>(open());
  Batch batch = good_batch(kSession, 0, 10);
  batch.blocks[3].tip_mm[0] += 1e-9;
  const auto answer = send(batch);
  ASSERT_TRUE(answer);
  EXPECT_EQ(accepted_.count, 0u);
  EXPECT_EQ(answer->verdict, Verdict::kGap);
  EXPECT_EQ(answer->next_sequence, 0u);
  EXPECT_NE(answer->text.find("corrupted"), std::string::npos);
  EXPECT_EQ(check_.counters().batches_corrupted, 1u);
}

TEST_F(Intake, ACountBeyondTheBatchCountsAsLost) {
  static_cast<void>(open());
  Batch batch = good_batch(kSession, 0, 32);
  batch.count = 4000000;
  batch.crc = dds::batch_crc(batch);
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, DropsBatchesOfAnOldSession) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  static_cast<void>(check_.on_queues_emptied("aborted by the operator", around_));
  static_cast<void>(open(0xdef));
  const auto answer = send(good_batch(kSession, 10, 10));
  EXPECT_EQ(accepted_.count, 0u);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->session, kSession);
  EXPECT_EQ(answer->verdict, Verdict::kAborted);
  EXPECT_EQ(answer->text, "aborted by the operator");
  EXPECT_EQ(check_.counters().batches_stale, 1u);
}

TEST_F(Intake, AnswersAnUnknownStationThatItsSessionIsNotOpen) {
  const auto answer = send(good_batch(0x123, 0, 10));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kClosed);
  EXPECT_NE(answer->text.find("session 123 is not open here"), std::string::npos);
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, NeverOpensAnOldSessionAgainButReportsHowItEnded) {
  static_cast<void>(open());
  static_cast<void>(check_.on_queues_emptied("aborted", around_));
  const auto answer = open();
  EXPECT_EQ(answer.verdict, Verdict::kAborted);
  EXPECT_EQ(answer.text, "aborted");
  EXPECT_FALSE(check_.is_held());
}

TEST_F(Intake, BeyondCreditDropsTheBlocksAndRefusesTheSession) {
  static_cast<void>(open());
  for (std::uint64_t i = 0; i < 3; ++i) static_cast<void>(send(good_batch(kSession, 32 * i, 32)));
  const auto answer = send(good_batch(kSession, 96, 32));
  ASSERT_TRUE(answer);
  EXPECT_EQ(accepted_.count, 0u);
  EXPECT_EQ(answer->verdict, Verdict::kBeyondCredit);
  EXPECT_NE(answer->text.find("credit up to 99"), std::string::npos) << answer->text;
  EXPECT_FALSE(send(good_batch(kSession, 96, 3)));
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, BeyondCreditIsCheckedForHugeSequencesToo) {
  static_cast<void>(open());
  const auto answer = send(good_batch(kSession, ~std::uint64_t{0} - 3, 8));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kBeyondCredit);
}

TEST_F(Intake, AQueueWithoutRoomEndsTheSessionInsteadOfLosingBlocksInSilence) {
  static_cast<void>(open());
  EXPECT_FALSE(send(good_batch(kSession, 0, 8)));
  const Credit answer = check_.on_queue_full(around_);
  EXPECT_EQ(answer.verdict, Verdict::kBeyondCredit);
  EXPECT_EQ(answer.credits, 0u);
  EXPECT_NE(answer.text.find("the block queue is full"), std::string::npos) << answer.text;
  static_cast<void>(send(good_batch(kSession, 8, 8)));
  EXPECT_EQ(accepted_.count, 0u) << "nothing after the loss may run";
}

TEST_F(Intake, CreditsNeverGoBack) {
  static_cast<void>(open());
  around_.free_slots = 10;
  EXPECT_EQ(open().credits, 99u);
}

TEST_F(Intake, RepeatsTheCreditUntilTheSessionEnds) {
  static_cast<void>(open());
  EXPECT_FALSE(check_.due_credit(around_));
  around_.now_ns += IntakeCheck::kCreditRepeat_ns;
  EXPECT_TRUE(check_.due_credit(around_));
  EXPECT_FALSE(check_.due_credit(around_));
  static_cast<void>(check_.on_queues_emptied("aborted", around_));
  around_.now_ns += IntakeCheck::kCreditRepeat_ns;
  EXPECT_FALSE(check_.due_credit(around_));
}

TEST_F(Intake, RepeatsTheCreditWhileBatchesKeepComing) {
  static_cast<void>(open());
  for (std::uint64_t i = 0; i < 4; ++i) {
    around_.now_ns += IntakeCheck::kCreditRepeat_ns / 2;
    static_cast<void>(send(good_batch(kSession, i, 1)));
    EXPECT_EQ(check_.due_credit(around_).has_value(), i % 2 == 1) << "batch " << i;
  }
}

TEST_F(Intake, GrantsCreditAtOnceWhenManyPlacesCameFree) {
  static_cast<void>(open());
  around_.free_slots += IntakeCheck::kCreditStep;
  const auto credit = check_.due_credit(around_);
  ASSERT_TRUE(credit);
  EXPECT_EQ(credit->credits, 99u + IntakeCheck::kCreditStep);
}

}  // namespace
}  // namespace meridian::stream
