// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/operator_events.hpp"

#include <gtest/gtest.h>

namespace meridian::simulate {
namespace {

TEST(OperatorEvents, CountFromTheStartOfALiveRun) {
  const auto events = read_operator_events(
      "cycle,verb,argument\n# a live run\n900,enable\n1000,start\r\n1500, hold\n\n1800,resume,\n"
      "1900,feed_override,0.5\n",
      "e.csv");
  ASSERT_TRUE(events.has_value()) << events.error();
  ASSERT_EQ(events->verbs.size(), 3U);
  EXPECT_EQ(events->verbs[0].cycle, 500);
  EXPECT_EQ(events->verbs[0].verb, Verb::kHold);
  EXPECT_EQ(events->verbs[1].cycle, 800);
  EXPECT_EQ(events->verbs[2].verb, Verb::kFeedOverride);
  EXPECT_EQ(events->verbs[2].argument, 0.5);
}

TEST(OperatorEvents, HoldWhereTheWorkpieceLayAtTheStart) {
  const auto events = read_operator_events(
      "0,frame,0,0,0,0,1,0,0,0,1,0,0,0,1\n1000,start,0\n500,frame,3,1,2,3,0,-1,0,1,0,0,0,0,1\n"
      "2000,frame,4,9,9,9,1,0,0,0,1,0,0,0,1\n",
      "e.csv");
  ASSERT_TRUE(events) << events.error();
  ASSERT_TRUE(events->frame);
  EXPECT_EQ(events->frame->number, 3);
  EXPECT_EQ(events->frame->origin_mm, (Array3{1, 2, 3}));
  EXPECT_TRUE(events->verbs.empty());
  EXPECT_FALSE(read_operator_events("1000,start\n", "e.csv")->frame);
  const auto torn = read_operator_events("0,frame,0,0,0\n", "e.csv");
  ASSERT_FALSE(torn);
  EXPECT_EQ(torn.error(), "e.csv:1: holds no work frame");
}

TEST(OperatorEvents, OfAProbingMoveAbortItWhereItHadContact) {
  const auto events = read_operator_events("1000,start,2\n1250,contact_found,1\n", "e.csv");
  ASSERT_TRUE(events) << events.error();
  ASSERT_EQ(events->verbs.size(), 1U);
  EXPECT_EQ(events->verbs[0].cycle, 250);
  EXPECT_EQ(events->verbs[0].verb, Verb::kAbort);
  EXPECT_FALSE(read_operator_events("1250,contact_found,0\n", "e.csv"));
}

TEST(OperatorEvents, CountAsTheyAreWithoutAStart) {
  const auto events = read_operator_events("10,hold\n20,abort", "e.csv");
  ASSERT_TRUE(events.has_value());
  ASSERT_EQ(events->verbs.size(), 2U);
  EXPECT_EQ(events->verbs[1].cycle, 20);
  EXPECT_TRUE(read_operator_events("", "e.csv")->verbs.empty());
}

TEST(OperatorEvents, HoldTheSwitchesOfTheStartAndEveryStartBehindABlock) {
  const auto events = read_operator_events(
      "900,optional_stop,1\n910,single_block,0\n920,single_block,1\n1000,start\n1500,start\n"
      "1600,single_block,0\n",
      "e.csv", 1.5);
  ASSERT_TRUE(events);
  const std::vector<OperatorEvent> expected{{-1, Verb::kSingleBlock, 1},
                                            {-1, Verb::kOptionalStop, 1},
                                            {500, Verb::kStart, 0},
                                            {600, Verb::kSingleBlock, 0}};
  ASSERT_EQ(events->verbs.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(events->verbs[n].cycle, expected[n].cycle);
    EXPECT_EQ(events->verbs[n].verb, expected[n].verb);
    EXPECT_EQ(events->verbs[n].argument, expected[n].argument);
  }
}

TEST(OperatorEvents, ThatWereSaidForADryRunAloneAreSaidToTheSimulationAsAnyOther) {
  const auto events = read_operator_events("900,enable,1\n1000,start,1\n1500,start,1\n", "e.csv");
  ASSERT_TRUE(events.has_value()) << events.error();
  ASSERT_EQ(events->verbs.size(), 1U);
  EXPECT_EQ(events->verbs[0].verb, Verb::kStart);
  EXPECT_EQ(events->verbs[0].argument, 0);
}

TEST(OperatorEvents, SayWhatTheHostDid) {
  const auto events = read_operator_events(
      "900,periods_lost,3\n1000,periods_lost,2\n1000,start,0\n1100,action_answered,1\n"
      "1200,periods_bridged,40\n1200,hold,0\n1300,action_answered,0\n",
      "e.csv");
  ASSERT_TRUE(events.has_value()) << events.error();
  ASSERT_EQ(events->losses.size(), 2U) << "those before the start do not count, its own do";
  EXPECT_EQ(events->losses[0].cycle, 0);
  EXPECT_EQ(events->losses[1].cycle, 200);
  EXPECT_EQ(events->losses[1].count, 40);
  EXPECT_TRUE(events->losses[1].is_bridged);
  EXPECT_FALSE(events->losses[0].is_bridged);
  ASSERT_EQ(events->answers.size(), 2U);
  EXPECT_TRUE(events->answers[0].is_done);
  EXPECT_EQ(events->answers[1].cycle, 300);
  EXPECT_FALSE(events->answers[1].is_done);
  ASSERT_EQ(events->verbs.size(), 1U);
}

TEST(OperatorEvents, HoldHowManyBlocksTheFirstStartedProgramBeganWith) {
  const auto events = read_operator_events(
      "10,plan_begun,1\n11,plan_looked,300\n30,plan_begun,1\n31,plan_looked,2048\n40,start,0\n"
      "60,plan_begun,1\n61,plan_looked,7\n",
      "e.csv");
  ASSERT_TRUE(events.has_value()) << events.error();
  ASSERT_EQ(events->feed_marks.size(), 2U);
  EXPECT_EQ(events->feed_marks[1].looked_at, 2048U);
  EXPECT_FALSE(read_operator_events("11,plan_looked,0\n", "e.csv").has_value());
  EXPECT_FALSE(read_operator_events("11,plan_looked,3,0\n", "e.csv").has_value());
  EXPECT_FALSE(read_operator_events("11,plan_looked,3,x\n", "e.csv").has_value());
  EXPECT_FALSE(read_operator_events("11,plan_looked,3,4,5\n", "e.csv").has_value());
}

TEST(OperatorEvents, HoldWhatThePlannerOfTheFirstStartedProgramReported) {
  const auto events = read_operator_events(
      "cycle,verb,argument,block,span\n10,plan_begun,1\n20,feed_planned,1.1,4,0\n"
      "30,plan_begun,1\n30,feed_override,0.9\n31,feed_override,1.25\n32,feed_planned,1.25,1,0\n"
      "40,start,0\n50,feed_override,1\n49,feed_planned,1,7,2\n60,plan_begun,1\n"
      "60,feed_planned,1.5,2,0\n",
      "e.csv", 1.5);
  ASSERT_TRUE(events.has_value()) << events.error();
  ASSERT_EQ(events->verbs.size(), 2U);
  EXPECT_EQ(events->verbs[0].cycle, -1) << "in force before the start";
  EXPECT_EQ(events->verbs[0].argument, 1.25);
  EXPECT_EQ(events->verbs[1].cycle, 10);
  ASSERT_EQ(events->feed_marks.size(), 3U);
  EXPECT_TRUE(events->feed_marks[0].is_begin);
  EXPECT_EQ(events->feed_marks[1].factor, 1.25);
  EXPECT_EQ(events->feed_marks[2].sequence, 7U);
  EXPECT_EQ(events->feed_marks[2].span, 2U);
}

TEST(OperatorEvents, AreRefusedWithTheirLine) {
  struct Case {
    const char* text;
    const char* message;
  };
  const Case cases[] = {
      {"x,hold\n", "e.csv:1: 'x' is no cycle number"},
      {"5,hold\nincomplete\n", "e.csv:2: the recorder lost events"},
      {"5,dance\n", "e.csv:1: 'dance' is no verb"},
      {"5,hold\n4,resume\n", "e.csv:2: cycles do not go up"},
      {"5,feed_override\n", "'feed_override' needs its factor"},
      {"5,feed_override,nan\n", "'nan' is no number"},
      {"5,feed_override,1.3\n", "'1.3' is no factor from 0 to 1"},
      {"5,periods_lost\n", "'periods_lost' needs a whole number"},
      {"5,periods_lost,-1\n", "'periods_lost' needs a whole number"},
      {"5,action_answered,2\n", "'action_answered' needs a whole number"},
      {"5,feed_planned,1.1,x,0\n", "'feed_planned' is no verb"},
      {"5,hold,1,2\n", "more than cycle, verb and argument"},
      {"5,single_block\n", "needs 1 (on) or 0 (off)"},
      {"5,optional_stop,0.5\n", "needs 1 (on) or 0 (off)"},
  };
  for (const Case& c : cases) {
    const auto events = read_operator_events(c.text, "e.csv");
    ASSERT_FALSE(events.has_value()) << c.text;
    EXPECT_NE(events.error().find(c.message), std::string::npos) << events.error();
  }
}

}  // namespace
}  // namespace meridian::simulate
