// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"

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
  SoftLimits wanted;
  wanted.put(vice_order(2.5, 40).box);
  expect_limits_outlive_the_service(plant, wanted, "*  keep-out vice b3 2.5 40 b4 -400 400\n");
}

TEST(SetUpKeepOut, RefusesAMoveIntoTheBoxAndOneThroughIt) {
  Plant plant;
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  SetUpOperator anna(plant, 100);
  const dds::Reply put_up = anna.ask(vice_order(20, 40));
  ASSERT_TRUE(put_up.is_accepted) << put_up.text;
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  for (const char* joints : {"b3=30", "b3=60"}) {
    expect_move_refused(plant, joints, "keep-out box vice");
  }
  expect_moved(plant, 19);
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
  expect_refused_by_preflight(plant, part, "joints enter the keep-out box ");
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
