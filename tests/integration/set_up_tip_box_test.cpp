// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "service/machine/file/machine_file.hpp"

/// The tip box of a machine that runs.
namespace meridian::test {
namespace {

/// Within `half_mm` of where the tip is, along X; anywhere along Y and Z.
LimitsOrder tip_order(Plant& plant, double half_mm) {
  const MachineModel model = config::load_machine(plant.machine());
  const dds::Status status = plant.status();
  const Array3 tip = tip_over_base(model, status.tool_length_mm, status.joints);
  LimitsOrder order;
  order.word = LimitsWord::kTip;
  order.box.min = {tip[0] - half_mm, -2000, -2000};
  order.box.max = {tip[0] + half_mm, 2000, 2000};
  return order;
}

TEST(SetUpTipBox, StopsAHandThatJogsAndOutlivesTheService) {
  Plant plant;
  plant.start_service();
  plant.start_drives();
  Process set = ctl_limits(plant, {"tip", "-2.5,-900,-900", "2.5,900,900"});
  ASSERT_EQ(set.wait(kToolPatience), 0) << set.said();
  EXPECT_NE(set.said().find("tip box (X -2.5 to 2.5 mm, Y -900 to 900 mm, Z -900 to 900 mm)"),
            std::string::npos)
      << set.said();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process jog = tool(plant, {"ctl", "jog", "b3", "20", "--for", "1"});
  ASSERT_EQ(jog.wait(kToolPatience), 0) << jog.said();
  const MachineModel model = config::load_machine(plant.machine());
  const dds::Status status = plant.status();
  EXPECT_NEAR(tip_over_base(model, status.tool_length_mm, status.joints)[0], 2.5, 1e-9);
  EXPECT_EQ(status.alarm, Alarm::kNone);
  SoftLimits wanted;
  wanted.put(TipBox{true, {-2.5, -900, -900}, {2.5, 900, 900}});
  expect_limits_outlive_the_service(plant, wanted, "*  tip      -2.5,-900,-900 2.5,900,900 mm\n");
}

TEST(SetUpTipBox, RefusesAMoveThatTakesTheTipOut) {
  Plant plant;
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  SetUpOperator anna(plant, 100);
  const dds::Reply set = anna.ask(tip_order(plant, 20));
  ASSERT_TRUE(set.is_accepted) << set.text;
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  expect_move_refused(plant, "b3=30", "tip box");
  expect_moved(plant, 19);
}

TEST(SetUpTipBox, IsSeenByTheStationsPreflightAndIsClearedAgain) {
  Plant plant;
  const std::string part = plant.folder() / "part.apt";
  write_cl_file(part, 12);
  plant.start_service();
  SetUpOperator anna(plant, 100);
  const dds::Reply reply = anna.ask(tip_order(plant, 0.5));
  ASSERT_TRUE(reply.is_accepted) << reply.text;
  expect_refused_by_preflight(plant, part, "the tip leaves the tip box: X at ");
  Process clear = ctl_limits(plant, {"clear", "tip"});
  ASSERT_EQ(clear.wait(kToolPatience), 0) << clear.said();
  EXPECT_TRUE(reported_by(plant).soft_limits.empty());
}

TEST(SetUpTipBox, ThatMeansNothingOrIsStaleIsRefused) {
  Plant plant;
  plant.start_service();
  SetUpOperator anna(plant, 100);
  const dds::Status before = plant.status();
  EXPECT_EQ(anna.ask(tip_order(plant, -1)).refusal, Refusal::kOutOfRange);
  EXPECT_EQ(plant.status().limits, before.limits);
  ASSERT_TRUE(anna.ask(tip_order(plant, 20)).is_accepted);
  SetUpOperator ben(plant, 200);
  ben.say(tip_order(plant, 30), before);  // has not seen anna's
  const auto late = ben.answer();
  ASSERT_TRUE(late);
  EXPECT_FALSE(late->is_accepted);
  EXPECT_EQ(late->refusal, Refusal::kStale) << late->text;
}

}  // namespace
}  // namespace meridian::test
