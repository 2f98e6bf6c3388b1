// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/feed_overrides.hpp"

#include <gtest/gtest.h>

namespace meridian::record {
namespace {

TEST(FeedInForce, IsTheLargestOfTheRampBeforeACycle) {
  FeedInForce in_force({{100, 1.5}, {200, 0.5}, {210, 1.2}}, 50);
  EXPECT_EQ(in_force.at(99), 1);
  EXPECT_EQ(in_force.at(100), 1.5);
  EXPECT_EQ(in_force.at(240), 1.5) << "in force until 199, less than 50 before";
  EXPECT_EQ(in_force.at(250), 1.2);
  EXPECT_EQ(in_force.at(900), 1.2);
}

TEST(FeedOverrides, AreReadFromTheEventsOfARecording) {
  const auto set = read_feed_overrides(
      "cycle,verb,argument,block,span\n5,plan_begun,1\n7,start,0\n9,feed_override,1.25\n"
      "9,feed_planned,1.25,3,0\n12,rapid_override,0.5\n20,feed_override,0.5\n");
  ASSERT_TRUE(set.has_value());
  ASSERT_EQ(set->size(), 2U);
  EXPECT_EQ((*set)[0].cycle, 9U);
  EXPECT_EQ((*set)[0].factor, 1.25);
  EXPECT_EQ((*set)[1].factor, 0.5);
  EXPECT_FALSE(read_feed_overrides("9,feed_override,1.25\nincomplete\n"));
}

}  // namespace
}  // namespace meridian::record
