// SPDX-License-Identifier: Apache-2.0
#include "service/simulate/operator_events.hpp"

#include <gtest/gtest.h>

namespace meridian::simulate {
namespace {

TEST(OperatorEvents, CountFromTheStartOfALiveRun) {
  const auto events = read_operator_events(
      "cycle,verb,argument\n# a live run\n900,enable\n1000,start\r\n1500, hold\n\n1800,resume,\n"
      "1900,feed_override,0.5\n",
      "e.csv");
  ASSERT_TRUE(events.has_value()) << events.error();
  ASSERT_EQ(events->size(), 3U);
  EXPECT_EQ((*events)[0].cycle, 500);
  EXPECT_EQ((*events)[0].verb, Verb::kHold);
  EXPECT_EQ((*events)[1].cycle, 800);
  EXPECT_EQ((*events)[2].verb, Verb::kFeedOverride);
  EXPECT_EQ((*events)[2].argument, 0.5);
}

TEST(OperatorEvents, CountAsTheyAreWithoutAStart) {
  const auto events = read_operator_events("10,hold\n20,abort", "e.csv");
  ASSERT_TRUE(events.has_value());
  ASSERT_EQ(events->size(), 2U);
  EXPECT_EQ((*events)[1].cycle, 20);
  EXPECT_TRUE(read_operator_events("", "e.csv")->empty());
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
      {"5,hold,1,2\n", "more than cycle, verb and argument"},
  };
  for (const Case& c : cases) {
    const auto events = read_operator_events(c.text, "e.csv");
    ASSERT_FALSE(events.has_value()) << c.text;
    EXPECT_NE(events.error().find(c.message), std::string::npos) << events.error();
  }
}

}  // namespace
}  // namespace meridian::simulate
