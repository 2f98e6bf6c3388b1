// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"
#include "service/protocol/limits_sum.hpp"

/// Keep-out boxes of a machine that runs.
namespace meridian::test {
namespace {

/// b3 from `min` to `max` while b4 is within 400 mm.
LimitsOrder vice_order(double min, double max) {
  LimitsOrder order;
  order.word = LimitsWord::kKeepOut;
  order.box.name = {"vice"};
  order.box.joints = 0b101;
  order.box.min = {min, 0, -400};
  order.box.max = {max, 0, 400};
  return order;
}

TEST(SetUpKeepOut, StopsAHandThatJogsAndOutlivesTheService) {
  Plant plant;
  plant.start_service();
  plant.start_drives();
  Process set = ctl_limits(plant, {"keep-out", "vice", "b3", "2.5", "40", "b4", "-400", "400"});
  ASSERT_EQ(set.wait(kToolPatience), 0) << set.said();
  EXPECT_NE(set.said().find("keep-out box vice (b3 2.5 to 40 mm, b4 -400 to 400 mm) in force"),
            std::string::npos)
      << set.said();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process jog = tool(plant, {"ctl", "jog", "b3", "20", "--for", "1"});
  ASSERT_EQ(jog.wait(kToolPatience), 0) << jog.said();
  EXPECT_NEAR(plant.status().joints[0], 2.5, 1e-9);
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  plant.start_service();
  SoftLimits wanted;
  wanted.put(vice_order(2.5, 40).box);
  EXPECT_EQ(reported_by(plant).soft_limits, wanted);
  EXPECT_EQ(plant.status().limits, stream::limits_sum(wanted));
  Process list = ctl_limits(plant, {"list"});
  ASSERT_EQ(list.wait(kToolPatience), 0) << list.said();
  EXPECT_NE(list.said().find("*  keep-out vice b3 2.5 40 b4 -400 400\n"), std::string::npos)
      << list.said();
}

TEST(SetUpKeepOut, RefusesAMoveIntoTheBoxAndOneThroughIt) {
  Plant plant;
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  SetUpOperator anna(plant, 100);
  const dds::Reply put_up = anna.ask(vice_order(20, 40));
  ASSERT_TRUE(put_up.is_accepted) << put_up.text;
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  const JointVector before = plant.status().joints;
  for (const char* joints : {"b3=30", "b3=60"}) {
    Process move = tool(plant, {"ctl", "move", "--joints", joints, "--feed", "3000"});
    EXPECT_NE(move.wait(milliseconds(20'000)), 0) << move.said();
    EXPECT_NE(move.said().find("keep-out box vice"), std::string::npos) << move.said();
    EXPECT_EQ(plant.status().joints, before);
    EXPECT_TRUE(plant.runs_until([](const dds::Status& status) {
      return status.state == State::kReady && status.session == 0;
    })) << plant.standing();
  }
  Process beside = tool(plant, {"ctl", "move", "--joints", "b3=19", "--feed", "3000"});
  EXPECT_EQ(beside.wait(milliseconds(20'000)), 0) << beside.said();
  EXPECT_NEAR(plant.status().joints[0], 19, 1e-9);
}

TEST(SetUpKeepOut, IsSeenByTheStationsPreflightAndOpensAgain) {
  Plant plant;
  const std::string part = plant.folder() / "part.apt";
  write_cl_file(part, 12);
  plant.start_service();
  SetUpOperator anna(plant, 100);
  // The part is cut with b3 on both sides of home, which stays free.
  for (const auto& [name, min, max] : {std::tuple{"left", -100.0, -1.0}, {"right", 1.0, 100.0}}) {
    LimitsOrder order = vice_order(min, max);
    order.box.name = {};
    std::copy_n(name, std::char_traits<char>::length(name), order.box.name.begin());
    const dds::Reply reply = anna.ask(order);
    ASSERT_TRUE(reply.is_accepted) << reply.text;
  }
  Process stream = tool(plant, {"stream", part});
  EXPECT_EQ(stream.wait(kToolPatience), 3) << stream.said();
  EXPECT_NE(stream.said().find("joints enter the keep-out box "), std::string::npos)
      << stream.said();
  EXPECT_NE(stream.said().find("part.apt:"), std::string::npos) << stream.said();
  Process open = ctl_limits(plant, {"open"});
  ASSERT_EQ(open.wait(kToolPatience), 0) << open.said();
  EXPECT_TRUE(reported_by(plant).soft_limits.empty());
}

TEST(SetUpKeepOut, ThatMeansNothingOrIsStaleIsRefused) {
  Plant plant;
  plant.start_service();
  SetUpOperator anna(plant, 100);
  const dds::Status before = plant.status();
  EXPECT_EQ(anna.ask(vice_order(40, 2.5)).refusal, Refusal::kOutOfRange);
  LimitsOrder open;
  open.word = LimitsWord::kOpen;
  open.box.name = {"probe"};
  const dds::Reply unknown = anna.ask(open);
  EXPECT_EQ(
      unknown.text,
      "limits refused: no keep-out box of that name was put up; see meridian ctl limits list");
  EXPECT_EQ(plant.status().limits, before.limits);
  ASSERT_TRUE(anna.ask(vice_order(2.5, 40)).is_accepted);
  SetUpOperator ben(plant, 200);
  ben.say(vice_order(3, 40), before);  // has not seen anna's
  const auto late = ben.answer();
  ASSERT_TRUE(late);
  EXPECT_FALSE(late->is_accepted);
  EXPECT_EQ(late->refusal, Refusal::kStale) << late->text;
}

}  // namespace
}  // namespace meridian::test
