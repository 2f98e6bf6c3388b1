// SPDX-License-Identifier: Apache-2.0

/// What ends a session: its blocks, its end mark, the planner, the station.

#include <limits>

#include "intake_under_test.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian::stream {
namespace {

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
  EXPECT_TRUE(check_.is_held()) << "its accepted blocks are the machine's to run";
  EXPECT_TRUE(check_.is_cut_off()) << "to their end";
}

TEST_F(Intake, AProgramRefusedAtItsFirstBlockFreesTheMachine) {
  static_cast<void>(open());
  static_cast<void>(send_spoilt(8, 0, [](ClBlock& block) { block.feed = -1; }));
  EXPECT_FALSE(check_.is_held());
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
  EXPECT_FALSE(check_.is_held());
}

TEST_F(Intake, AProgramWithActionsIsRefusedWithoutTheirPeer) {
  around_.actions = {};
  dds::SessionRequest request = open_request();
  request.policies = dds::kPolicyContainsActions;
  const Credit answer = check_.on_request(request, around_, 100);
  EXPECT_EQ(answer.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(answer.text.find("auxiliary = \"ignore\""), std::string::npos);
}

TEST_F(Intake, AProgramThatWantsBothTransitionsIsRefused) {
  dds::SessionRequest request = open_request();
  request.policies = dds::kPolicyExactStop | dds::kPolicySmooth;
  EXPECT_EQ(check_.on_request(request, around_, 100).verdict, Verdict::kRefusedProgram);
  request.policies = dds::kPolicySmooth;
  EXPECT_EQ(check_.on_request(request, around_, 100).verdict, Verdict::kGood);
}

TEST_F(Intake, AProgramThatBeginsAtJointsOutsideOfTravelIsRefusedByName) {
  const auto ask = [this](std::size_t joint, double at) {
    dds::SessionRequest request = open_request(++session_);
    request.policies = dds::kPolicyFirstJoints;
    request.first_joints[joint] = at;
    return check_.on_request(request, around_, 100);
  };
  const Credit beyond = ask(0, 1e4);
  EXPECT_EQ(beyond.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(beyond.text.find("outside of the travel of b3"), std::string::npos) << beyond.text;
  EXPECT_EQ(ask(1, std::nan("")).verdict, Verdict::kRefusedProgram);
  EXPECT_EQ(ask(5, 1).verdict, Verdict::kRefusedProgram) << "the machine has five";
  EXPECT_EQ(ask(0, 10).verdict, Verdict::kGood);
}

TEST_F(Intake, AToleranceBelowWhatIsPlannedForIsRefusedByNameAndLeast) {
  const auto ask = [this](double tip_mm, double axis_rad) {
    dds::SessionRequest request = open_request(++session_);
    request.tip_tolerance_mm = tip_mm;
    request.axis_tolerance_rad = axis_rad;
    request.policies = dds::kPolicySmooth;
    return check_.on_request(request, around_, 100);
  };
  const Credit tip = ask(0.0005, 0);
  EXPECT_EQ(tip.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(tip.text.find("tip tolerance of the program is 0.0005 mm; allowed is 0.001 to 10 mm"),
            std::string::npos)
      << tip.text;
  const Credit axis = ask(0.01, 9e-5);
  EXPECT_EQ(axis.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(axis.text.find("axis tolerance of the program is 9e-05 rad; allowed is 0.0001 to 0.17"),
            std::string::npos)
      << axis.text;
  for (const double wrong : {-1.0, 1e-12, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(ask(wrong, 0).verdict, Verdict::kRefusedProgram) << wrong;
    EXPECT_EQ(ask(0, wrong).verdict, Verdict::kRefusedProgram) << wrong;
  }
  EXPECT_FALSE(check_.is_held());
  EXPECT_EQ(ask(0.001, 1e-4).verdict, Verdict::kGood);
}

TEST_F(Intake, AToleranceAboveWhatIsPlannedForIsRefusedWhateverTheTransition) {
  dds::SessionRequest request = open_request();
  request.tip_tolerance_mm = 10.001;
  const Credit tip = check_.on_request(request, around_, 100);
  EXPECT_EQ(tip.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(
      tip.text.find("tip tolerance of the program is 10.001 mm; allowed is more than 0, up to "),
      std::string::npos)
      << tip.text;
  request.policies = dds::kPolicySmooth;
  request.tip_tolerance_mm = kMaxTipTolerance_mm;
  request.axis_tolerance_rad = 0.175;
  const Credit axis = check_.on_request(request, around_, 100);
  EXPECT_EQ(axis.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(axis.text.find("axis tolerance of the program is 0.175 rad"), std::string::npos)
      << axis.text;
  request.axis_tolerance_rad = kMaxAxisTolerance_rad;
  EXPECT_EQ(check_.on_request(request, around_, 100).verdict, Verdict::kGood);
}

TEST_F(Intake, ARefusalPrintsAToleranceJustBelowTheMinimumWithEnoughDigits) {
  dds::SessionRequest request = open_request();
  request.policies = dds::kPolicySmooth;
  request.tip_tolerance_mm = 0.00099999999;
  const Credit refused = check_.on_request(request, around_, 100);
  EXPECT_NE(refused.text.find("is 0.00099999999 mm; allowed is 0.001 to 10 mm"), std::string::npos)
      << refused.text;
}

TEST_F(Intake, FineTolerancesAreRefusedOnlyWhereTheRunIsSmooth) {
  const auto ask = [this](double tip_mm, std::uint32_t policies) {
    dds::SessionRequest request = open_request(++session_);
    request.tip_tolerance_mm = tip_mm;
    request.policies = policies;
    const Credit credit = check_.on_request(request, around_, 100);
    static_cast<void>(close(session_));
    return credit;
  };
  EXPECT_EQ(ask(0.0005, 0).verdict, Verdict::kGood) << "the machine's exact stop";
  EXPECT_EQ(ask(0.0005, dds::kPolicyExactStop).verdict, Verdict::kGood);
  model_.tolerances.tip_mm = 0.0005;
  EXPECT_EQ(ask(0, 0).verdict, Verdict::kGood);
  const Credit of_machine = ask(0, dds::kPolicySmooth);
  EXPECT_EQ(of_machine.verdict, Verdict::kRefusedProgram);
  EXPECT_NE(of_machine.text.find("tip tolerance of the machine is 0.0005 mm"), std::string::npos)
      << of_machine.text;
  EXPECT_EQ(ask(0.001, dds::kPolicySmooth).verdict, Verdict::kGood);
  model_.transition = Transition::kSmooth;
  EXPECT_EQ(ask(0.0005, 0).verdict, Verdict::kRefusedProgram) << "the machine's smooth";
  EXPECT_EQ(ask(0.0005, dds::kPolicyExactStop).verdict, Verdict::kGood);
}

TEST_F(Intake, ThePlannersVerdictEndsTheSessionWithTheSameWords) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  const auto answer =
      check_.on_planner_reject({4, 14, RejectCode::kTravelBetween, 3, 13.0}, around_);
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
  const auto last = check_.on_program_end(around_);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->verdict, Verdict::kRan);
  EXPECT_EQ(open(0xdef, "cam-2").verdict, Verdict::kGood);
}

TEST_F(Intake, AStationThatDiesLeavesItsBlocksAndHoldsTheMachine) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  check_.on_station_lost(kSession);
  const Credit answer = open(0xdef, "cam-2");
  EXPECT_EQ(answer.verdict, Verdict::kRefusedStation);
  EXPECT_NE(answer.text.find("cam-1 with program part.cls, which is gone; enable"),
            std::string::npos)
      << answer.text;
  EXPECT_FALSE(check_.is_cut_off()) << "it may come back with more";
}

TEST_F(Intake, AStationThatDiesWithoutABlockFreesTheMachine) {
  static_cast<void>(open());
  check_.on_station_lost(kSession);
  EXPECT_EQ(open(0xdef, "cam-2").verdict, Verdict::kGood);
}

TEST_F(Intake, ACloseBeforeTheEndAcceptsNothingMore) {
  static_cast<void>(open());
  static_cast<void>(send(good_batch(kSession, 0, 10)));
  const Credit answer = close();
  EXPECT_EQ(answer.verdict, Verdict::kClosed);
  EXPECT_NE(answer.text.find("runs the 10 blocks"), std::string::npos) << answer.text;
  EXPECT_TRUE(check_.is_cut_off());
  EXPECT_FALSE(send(good_batch(kSession, 10, 10)));
  EXPECT_EQ(accepted_.count, 0u);
}

TEST_F(Intake, ACloseWithoutABlockFreesTheMachine) {
  static_cast<void>(open());
  EXPECT_EQ(close().verdict, Verdict::kClosed);
  EXPECT_FALSE(check_.is_held());
  EXPECT_FALSE(check_.is_cut_off());
}

}  // namespace
}  // namespace meridian::stream
