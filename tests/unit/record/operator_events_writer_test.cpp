// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/operator_events_writer.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"

namespace meridian::record {
namespace {

TEST(OperatorEventsWriter, KeepsWhatTheMotionFollowsFromWithCycleAndArgument) {
  const test::Scratch file(".csv");
  auto writer = OperatorEventsWriter::create(file.path());
  ASSERT_TRUE(writer.has_value());
  Event event;
  event.cycle = 1203;
  event.code = EventCode::kAccepted;
  event.b = static_cast<std::uint64_t>(Verb::kStart);
  EXPECT_TRUE(writer->write(event));
  event.cycle = 2000;
  event.b = static_cast<std::uint64_t>(Verb::kFeedOverride);
  event.x = 0.1;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kRefused;
  EXPECT_TRUE(writer->write(event));
  event.cycle = 2100;
  event.code = EventCode::kPeriodsLost;
  event.a = 17;
  event.b = 1;
  EXPECT_TRUE(writer->write(event));
  event.a = 70;
  event.b = 0;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kActionAnswered;
  event.x = 1;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kContactFound;
  event.a = 2;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kContactJoint;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kPlanBegun;
  event.x = 110.5;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kFeedPlanned;
  event.a = 12;
  event.b = 3;
  event.x = 1.25;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kPlanLooked;
  event.a = 300;
  event.b = 0;
  EXPECT_TRUE(writer->write(event));
  event.b = 57;
  EXPECT_TRUE(writer->write(event));
  event.code = EventCode::kAccepted;
  event.b = static_cast<std::uint64_t>(Verb::kDryRun);  // nor of jog and home: no program is there
  EXPECT_TRUE(writer->write(event));
  EXPECT_EQ(test::read_text(file.path()),
            "cycle,verb,argument,block,span\n1203,start,0\n2000,feed_override,0.10000000000000001\n"
            "2100,periods_bridged,17\n2100,periods_lost,70\n2100,action_answered,1\n"
            "2100,contact_found,2\n"
            "2100,plan_begun,1,110.5\n2100,feed_planned,1.25,12,3\n2100,plan_looked,300\n"
            "2100,plan_looked,300,57\n");
}

TEST(OperatorEventsWriter, SitsBesideItsRecording) {
  EXPECT_EQ(operator_events_path("a.b/run.csv"), "a.b/run.events.csv");
  EXPECT_EQ(operator_events_path("a.b/run"), "a.b/run.events.csv");
}

}  // namespace
}  // namespace meridian::record
