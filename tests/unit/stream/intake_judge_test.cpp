// SPDX-License-Identifier: Apache-2.0
#include "service/stream/intake_judge.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>

#include "support/machines.hpp"
#include "support/programs.hpp"

namespace meridian::stream {
namespace {

using dds::Batch;
using dds::Credit;
using dds::Verdict;
using test::good_batch;

constexpr std::uint64_t kSession = 0xabc;

dds::SessionRequest open_request(std::uint64_t session = kSession,
                                 const std::string& station = "cam-1") {
  return {.session = session, .station = station, .program = "part.cls"};
}

class Intake : public testing::Test {
 protected:
  Credit open(std::uint64_t session = kSession, const std::string& station = "cam-1") {
    return judge_.on_request(open_request(session, station), around_, model_.tool_length_mm);
  }
  Credit close(std::uint64_t session = kSession) {
    dds::SessionRequest request = open_request(session);
    request.request = dds::SessionRequestKind::kClose;
    return judge_.on_request(request, around_, model_.tool_length_mm);
  }
  std::optional<Credit> send(const Batch& batch) {
    auto answer = judge_.on_batch(batch, around_, accepted_);
    around_.free_places -= accepted_.count;
    return answer;
  }
  /// A batch of `count` good blocks whose block `bad` is spoilt by `spoil`, CRC right.
  template <class Spoil>
  std::optional<Credit> send_spoilt(std::uint32_t count, std::uint32_t bad, Spoil spoil) {
    Batch batch = good_batch(kSession, judge_.next_sequence(), count);
    spoil(batch.blocks[bad]);
    batch.crc = dds::batch_crc(batch);
    return send(batch);
  }

  MachineModel model_ = test::lai_machine();
  IntakeJudge judge_{model_, {{1, 80.0}}, 99};
  Surroundings around_{.now_ns = 0, .free_places = 100, .actions = {.is_there = true}};
  Accepted accepted_;
  std::uint64_t session_ = kSession;
};

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
  EXPECT_EQ(judge_.next_sequence(), 37u);
}

TEST_F(Intake, RefusesASecondStationByName) {
  static_cast<void>(open());
  const Credit answer = open(0xdef, "cam-2");
  EXPECT_EQ(answer.session, 0xdefu);
  EXPECT_EQ(answer.verdict, Verdict::kRefusedStation);
  EXPECT_NE(answer.text.find("held by station cam-1 with program part.cls"), std::string::npos)
      << answer.text;
  EXPECT_EQ(judge_.session(), kSession);
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
  EXPECT_EQ(judge_.counters().batches_duplicate, 1u);
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
  EXPECT_EQ(judge_.counters().batches_corrupted, 1u);
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
  static_cast<void>(judge_.on_queues_emptied("aborted by the operator", around_));
  static_cast<void>(open(0xdef));
  const auto answer = send(good_batch(kSession, 10, 10));
  EXPECT_EQ(accepted_.count, 0u);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->session, kSession);
  EXPECT_EQ(answer->verdict, Verdict::kAborted);
  EXPECT_EQ(answer->text, "aborted by the operator");
  EXPECT_EQ(judge_.counters().batches_stale, 1u);
}

TEST_F(Intake, TellsAStrangerThatItsSessionIsNotOpen) {
  const auto answer = send(good_batch(0x123, 0, 10));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kClosed);
  EXPECT_NE(answer->text.find("session 123 is not open here"), std::string::npos);
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, NeverOpensAnOldSessionAgainButTellsHowItEnded) {
  static_cast<void>(open());
  static_cast<void>(judge_.on_queues_emptied("aborted", around_));
  const auto answer = open();
  EXPECT_EQ(answer.verdict, Verdict::kAborted);
  EXPECT_EQ(answer.text, "aborted");
  EXPECT_FALSE(judge_.is_held());
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

TEST_F(Intake, BeyondCreditIsJudgedForHugeSequencesToo) {
  static_cast<void>(open());
  const auto answer = send(good_batch(kSession, ~std::uint64_t{0} - 3, 8));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kBeyondCredit);
}

TEST_F(Intake, AQueueWithoutRoomEndsTheSessionInsteadOfLosingBlocksInSilence) {
  static_cast<void>(open());
  EXPECT_FALSE(send(good_batch(kSession, 0, 8)));
  const Credit answer = judge_.on_queue_full(around_);
  EXPECT_EQ(answer.verdict, Verdict::kBeyondCredit);
  EXPECT_EQ(answer.credits, 0u);
  EXPECT_NE(answer.text.find("the block queue is full"), std::string::npos) << answer.text;
  static_cast<void>(send(good_batch(kSession, 8, 8)));
  EXPECT_EQ(accepted_.count, 0u) << "nothing behind the loss may run";
}

TEST_F(Intake, CreditsNeverGoBack) {
  static_cast<void>(open());
  around_.free_places = 10;
  EXPECT_EQ(open().credits, 99u);
}

TEST_F(Intake, ARefusedBlockNamesSequenceLineAndReason) {
  static_cast<void>(open());
  const auto answer = send_spoilt(
      8, 5, [](ClBlock& block) { block.tip_mm[1] = std::numeric_limits<double>::quiet_NaN(); });
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kRefusedBlock);
  EXPECT_EQ(answer->verdict_sequence, 5u);
  EXPECT_EQ(answer->verdict_line, 15u);
  EXPECT_EQ(answer->text, "line 15, block 5: tip y is not a finite number");
  EXPECT_EQ(answer->credits, 0u);
}

TEST_F(Intake, BlocksBeforeARefusedOneStayAndNoneAfterItComes) {
  static_cast<void>(open());
  static_cast<void>(send_spoilt(8, 5, [](ClBlock& block) { block.axis = {0, 0, 0}; }));
  EXPECT_EQ(accepted_.count, 5u);
  EXPECT_FALSE(send(good_batch(kSession, 5, 8)));
  EXPECT_EQ(accepted_.count, 0u);
  EXPECT_TRUE(judge_.is_held()) << "its accepted blocks are the machine's to run";
}

TEST_F(Intake, AProgramRefusedAtItsFirstBlockFreesTheMachine) {
  static_cast<void>(open());
  static_cast<void>(send_spoilt(8, 0, [](ClBlock& block) { block.feed = -1; }));
  EXPECT_FALSE(judge_.is_held());
  EXPECT_EQ(open(0xdef, "cam-2").verdict, Verdict::kGood);
}

TEST_F(Intake, ABlockThatCarriesAnotherNumberIsRefused) {
  static_cast<void>(open());
  const auto answer = send_spoilt(8, 3, [](ClBlock& block) { block.sequence = 7; });
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kRefusedBlock);
}

TEST_F(Intake, TheEndMarkAddsAnEndBlock) {
  static_cast<void>(open());
  const auto answer = send(good_batch(kSession, 0, 10, true));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kComplete);
  ASSERT_EQ(accepted_.count, 11u);
  EXPECT_EQ(accepted_.blocks[10].kind, BlockKind::kEnd);
}

TEST_F(Intake, TheEndMarkMayComeAlone) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  const auto answer = send(good_batch(kSession, 10, 0, true));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kComplete);
  EXPECT_EQ(accepted_.count, 1u);
}

TEST_F(Intake, ARepeatedEndMarkIsAnsweredAndChangesNothing) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10, true)));
  const auto answer = send(good_batch(kSession, 0, 10, true));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kComplete);
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, AnEmptyProgramIsRefused) {
  static_cast<void>(open());
  const auto answer = send(good_batch(kSession, 0, 0, true));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kRefusedProgram);
  EXPECT_FALSE(judge_.is_held());
}

TEST_F(Intake, AProgramWithActionsIsRefusedWithoutTheirPeer) {
  around_.actions = {};
  dds::SessionRequest request = open_request();
  request.policies = dds::kPolicyContainsActions;
  const Credit answer = judge_.on_request(request, around_, 100);
  EXPECT_EQ(answer.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(answer.text.find("auxiliary = \"ignore\""), std::string::npos);
}

TEST_F(Intake, AProgramThatWantsBothTransitionsIsRefused) {
  dds::SessionRequest request = open_request();
  request.policies = dds::kPolicyExactStop | dds::kPolicySmooth;
  EXPECT_EQ(judge_.on_request(request, around_, 100).verdict, Verdict::kRefusedProgram);
  request.policies = dds::kPolicySmooth;
  EXPECT_EQ(judge_.on_request(request, around_, 100).verdict, Verdict::kGood);
}

TEST_F(Intake, AToleranceBelowWhatIsPlannedForIsRefusedByNameAndLeast) {
  const auto ask = [this](double tip_mm, double axis_rad) {
    dds::SessionRequest request = open_request(++session_);
    request.tip_tolerance_mm = tip_mm;
    request.axis_tolerance_rad = axis_rad;
    return judge_.on_request(request, around_, 100);
  };
  const Credit tip = ask(0.0005, 0);
  EXPECT_EQ(tip.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(tip.text.find("tip tolerance of the program is 0.0005 mm; allowed is 0.001 mm or more"),
            std::string::npos)
      << tip.text;
  const Credit axis = ask(0.01, 9e-5);
  EXPECT_EQ(axis.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(axis.text.find("axis tolerance of the program is 9e-05 rad; allowed is 0.0001 rad"),
            std::string::npos)
      << axis.text;
  for (const double wrong : {-1.0, 1e-12, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(ask(wrong, 0).verdict, Verdict::kRefusedProgram) << wrong;
    EXPECT_EQ(ask(0, wrong).verdict, Verdict::kRefusedProgram) << wrong;
  }
  EXPECT_FALSE(judge_.is_held());
  EXPECT_EQ(ask(0.001, 1e-4).verdict, Verdict::kGood);
}

TEST_F(Intake, ThePlannersVerdictEndsTheSessionWithTheSameWords) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  const auto answer =
      judge_.on_planner_reject({4, 14, RejectCode::kTravelBetween, 3, 13.0}, around_);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::kRefusedBlock);
  EXPECT_EQ(answer->verdict_joint, 3);
  EXPECT_NE(answer->text.find("line 14, block 4: theta1 at "), std::string::npos) << answer->text;
  EXPECT_FALSE(send(good_batch(kSession, 10, 10)));
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, TheMachineIsFreeWhenTheProgramRan) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10, true)));
  const auto last = judge_.on_program_end(around_);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->verdict, Verdict::kRan);
  EXPECT_EQ(open(0xdef, "cam-2").verdict, Verdict::kGood);
}

TEST_F(Intake, AStationThatDiesLeavesItsBlocksAndHoldsTheMachine) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  judge_.on_station_lost(kSession);
  const Credit answer = open(0xdef, "cam-2");
  EXPECT_EQ(answer.verdict, Verdict::kRefusedStation);
  EXPECT_NE(answer.text.find("cam-1 with program part.cls, which is gone; enable"),
            std::string::npos)
      << answer.text;
}

TEST_F(Intake, AStationThatDiesWithoutABlockFreesTheMachine) {
  static_cast<void>(open());
  judge_.on_station_lost(kSession);
  EXPECT_EQ(open(0xdef, "cam-2").verdict, Verdict::kGood);
}

TEST_F(Intake, ACloseBeforeTheEndAcceptsNothingMore) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  const Credit answer = close();
  EXPECT_EQ(answer.verdict, Verdict::kClosed);
  EXPECT_NE(answer.text.find("runs the 10 blocks"), std::string::npos) << answer.text;
  EXPECT_FALSE(send(good_batch(kSession, 10, 10)));
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, ACloseWithoutABlockFreesTheMachine) {
  static_cast<void>(open());
  EXPECT_EQ(close().verdict, Verdict::kClosed);
  EXPECT_FALSE(judge_.is_held());
}

TEST_F(Intake, RepeatsTheCreditUntilTheSessionEnds) {
  static_cast<void>(open());
  EXPECT_FALSE(judge_.due_credit(around_));
  around_.now_ns += IntakeJudge::kCreditRepeat_ns;
  EXPECT_TRUE(judge_.due_credit(around_));
  EXPECT_FALSE(judge_.due_credit(around_));
  static_cast<void>(judge_.on_queues_emptied("aborted", around_));
  around_.now_ns += IntakeJudge::kCreditRepeat_ns;
  EXPECT_FALSE(judge_.due_credit(around_));
}

TEST_F(Intake, RepeatsTheCreditWhileBatchesKeepComing) {
  static_cast<void>(open());
  for (std::uint64_t i = 0; i < 4; ++i) {
    around_.now_ns += IntakeJudge::kCreditRepeat_ns / 2;
    static_cast<void>(send(good_batch(kSession, i, 1)));
    EXPECT_EQ(judge_.due_credit(around_).has_value(), i % 2 == 1) << "batch " << i;
  }
}

TEST_F(Intake, TellsAtOnceWhenManyPlacesCameFree) {
  static_cast<void>(open());
  around_.free_places += IntakeJudge::kCreditStep;
  const auto credit = judge_.due_credit(around_);
  ASSERT_TRUE(credit);
  EXPECT_EQ(credit->credits, 99u + IntakeJudge::kCreditStep);
}

}  // namespace
}  // namespace meridian::stream
