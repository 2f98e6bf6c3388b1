// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/limits_sum.hpp"

/// Soft limits of a machine that runs.
namespace meridian::test {
namespace {

void say_limits(const Plant& plant, const std::vector<std::string>& words) {
  std::vector<std::string> all{"ctl", "limits"};
  all.insert(all.end(), words.begin(), words.end());
  Process limits = tool(plant, all);
  ASSERT_EQ(limits.wait(kToolPatience), 0) << limits.said();
}

TEST(SetUpLimits, SetLiveAreThoseOfAServiceThatWasStartedWithThemBitForBit) {
  const LiveRun bare;
  Plant plant;
  const std::string part = plant.folder() / "part.apt";
  write_cl_file(part, 12);
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  ASSERT_NO_FATAL_FAILURE(say_limits(plant, {"set", "b3", "-40", "62.5"}));
  ASSERT_TRUE(plant.enable()) << plant.service().said();  // in Ready, beside the drives
  ASSERT_NO_FATAL_FAILURE(say_limits(plant, {"set", "theta1", "-200", "190"}));
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  ASSERT_NO_FATAL_FAILURE(end_service(plant));

  Plant filed;
  filed.change_machine({{R"((\[joints\.b3\][^\[]*travel_mm = )\[[^\]]*\])", "$1[-40, 62.5]"},
                        {R"((\[joints\.theta1\][^\[]*travel_deg = )\[[^\]]*\])", "$1[-200, 190]"}});
  filed.start_service({"--service", service_file(filed)});
  filed.start_drives();
  ASSERT_NO_FATAL_FAILURE(cut(filed, part));
  ASSERT_NO_FATAL_FAILURE(end_service(filed));
  const std::string simulated = simulate_part(filed, part, bare);
  ASSERT_NO_FATAL_FAILURE(expect_same(filed, simulated));
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated));

  // The recording says under which limits it was cut: for a replay, and for who checks it.
  const std::string events = (plant.folder() / "recording.events.csv").string();
  ASSERT_NO_FATAL_FAILURE(
      expect_same(plant, simulate_part(plant, part, bare, {"--events", events})));
  ASSERT_NO_FATAL_FAILURE(expect_checked(plant, part, bare));
  std::ofstream(events, std::ios::app) << "0,limits,1,-40,1\n";  // as if they had been narrower
  Process narrower({"meridian", "check", plant.recording(), part, "--machine", plant.machine(),
                    "--max-missing", "1000000"},
                   plant.folder() / "check.log");
  EXPECT_EQ(narrower.wait(milliseconds(60'000)), 1) << narrower.said();
  EXPECT_NE(narrower.said().find("b3 is outside its travel"), std::string::npos) << narrower.said();
}

TEST(SetUpLimits, AreSeenByTheStationsPreflightWithJointBlockAndLine) {
  Plant plant;
  const std::string part = plant.folder() / "part.apt";
  write_cl_file(part, 12);
  plant.start_service();
  ASSERT_NO_FATAL_FAILURE(say_limits(plant, {"set", "theta1", "-5", "5"}));
  Process stream = tool(plant, {"stream", part});
  EXPECT_EQ(stream.wait(kToolPatience), 3) << stream.said();
  EXPECT_NE(stream.said().find("(travel -5 to 5 deg) leaves travel at this block"),
            std::string::npos)
      << stream.said();
  EXPECT_NE(stream.said().find("part.apt:"), std::string::npos) << stream.said();
  ASSERT_NO_FATAL_FAILURE(say_limits(plant, {"clear"}));
  EXPECT_TRUE(reported_by(plant).soft_limits.empty());
}

TEST(SetUpLimits, StopAHandThatJogs) {
  Plant plant;
  plant.start_service();
  plant.start_drives();
  ASSERT_NO_FATAL_FAILURE(say_limits(plant, {"set", "b3", "-40", "2.5"}));
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process jog = tool(plant, {"ctl", "jog", "b3", "20", "--for", "1"});
  ASSERT_EQ(jog.wait(kToolPatience), 0) << jog.said();
  EXPECT_NEAR(plant.status().joints[0], 2.5, 1e-9);
}

TEST(SetUpLimits, SurviveTheServiceAndAreListed) {
  Plant plant;
  SetUpOperator anna(plant, 100);
  plant.start_service();
  const LimitsOrder order{LimitsWord::kSet, 0, -40, 42.5};
  const dds::Reply reply = anna.ask(order);
  ASSERT_TRUE(reply.is_accepted) << reply.text;
  EXPECT_EQ(reply.text, "soft limits b3 -40 to 42.5 mm in force");
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  plant.start_service();
  SoftLimits wanted;
  wanted.put(0, -40, 42.5);
  EXPECT_EQ(reported_by(plant).soft_limits, wanted);
  EXPECT_EQ(plant.status().limits, stream::limits_sum(wanted));
  Process list = tool(plant, {"ctl", "limits", "list"});
  ASSERT_EQ(list.wait(kToolPatience), 0) << list.said();
  EXPECT_NE(list.said().find("*  b3       -40 42.5 mm, of -600 600\n   b2       -600 600 mm\n"),
            std::string::npos)
      << list.said();
  const dds::Reply wider = anna.ask(LimitsOrder{LimitsWord::kSet, 0, -40, 601});
  EXPECT_EQ(wider.refusal, Refusal::kOutOfRange);
  EXPECT_EQ(wider.text,
            "limits refused: b3 has a travel of -600 to 600 mm, which soft limits only shrink");
}

TEST(SetUpLimits, ThatTheMachineFileHoldsNoMoreKeepTheServiceFromStarting) {
  Plant plant;
  plant.start_service();
  ASSERT_NO_FATAL_FAILURE(say_limits(plant, {"set", "b3", "-40", "42.5"}));
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  plant.change_machine({{R"((\[joints\.b3\][^\[]*travel_mm = )\[[^\]]*\])", "$1[-39, 600]"}});
  constexpr int kCannotStart = 1;
  EXPECT_EQ(plant.start_service().wait(kToolPatience), kCannotStart);
  EXPECT_NE(plant.service().said().find(
                "lai.setup holds soft limits b3 -40 to 42.5 mm, not inside "
                "the travel of the machine file; start with the machine file of before"),
            std::string::npos)
      << plant.service().said();
}

TEST(SetUpLimits, StayAsTheyAreWhileAProgramIsThereOrTheMachineMoves) {
  Plant plant;
  SetUpOperator anna(plant, 100);
  const auto expect_refused = [&](Refusal why) {
    const std::uint64_t before = plant.status().limits;
    const dds::Reply reply = anna.ask(LimitsOrder{LimitsWord::kSet, 0, -1, 1});
    EXPECT_FALSE(reply.is_accepted);
    EXPECT_EQ(reply.refusal, why) << reply.text;
    EXPECT_EQ(plant.status().limits, before);
  };
  expect_refused_beside_a_program(plant, expect_refused);
}

TEST(SetUpLimits, AreThoseOfOneOfTwoOperatorsWhoSawTheSame) {
  Plant plant;
  SetUpOperator anna(plant, 100), bert(plant, 101);
  plant.start_service();
  int decided = 0;
  for (int round = 1; round <= 5; ++round) {
    SCOPED_TRACE(round);
    const dds::Status seen = plant.status();
    anna.say(LimitsOrder{LimitsWord::kSet, 0, -1.0 * round, 10}, seen);
    bert.say(LimitsOrder{LimitsWord::kSet, 0, -1.0 * round, 20}, seen);
    const auto a = anna.answer(), b = bert.answer();
    ASSERT_TRUE(a && b) << plant.standing();
    if (!a->is_accepted && !b->is_accepted) continue;  // the host was slow: both saw an old status
    ASSERT_NE(a->is_accepted, b->is_accepted) << a->text << "\n" << b->text;
    EXPECT_EQ((a->is_accepted ? b : a)->refusal, Refusal::kStale);
    SoftLimits wanted;
    wanted.put(0, -round, a->is_accepted ? 10 : 20);
    EXPECT_EQ(reported_by(plant).soft_limits, wanted);
    ++decided;
  }
  EXPECT_GT(decided, 0);
}

TEST(SetUpLimits, RefuseAProgramThatWasCheckedUnderOthers) {
  Plant plant;
  SetUpOperator anna(plant, 100);
  plant.start_service();
  const std::uint64_t old_sum = plant.status().limits;
  EXPECT_EQ(old_sum, stream::limits_sum(SoftLimits()));
  ASSERT_TRUE(anna.ask(LimitsOrder{LimitsWord::kSet, 0, -1, 1}).is_accepted);
  ASSERT_TRUE(
      plant.runs_until([&](const dds::Status& status) { return status.limits != old_sum; }));
  SetUpStation station(plant);
  ASSERT_TRUE(station.is_connected());
  const dds::Credit stale = station.open(51, {.limits = old_sum});
  EXPECT_EQ(stale.verdict, dds::Verdict::kRefusedProgram);
  EXPECT_NE(stale.text.find("stale: "), std::string::npos) << stale.text;
  EXPECT_EQ(station.open(52, {.limits = plant.status().limits}).verdict, dds::Verdict::kGood);
}

}  // namespace
}  // namespace meridian::test
