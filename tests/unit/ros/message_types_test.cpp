// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/message_types.hpp"

#include <gtest/gtest.h>

#include "support/machines.hpp"

namespace meridian::ros {
namespace {

TEST(MessageTypes, CarryEveryTypeThatTheyReferTo) {
  const std::string line(80, '=');
  EXPECT_EQ(joint_state_type().text,
            "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
            "float64[] effort\n" +
                line + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
                line + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

TEST(MessageTypes, HaveAFieldForEveryJointUnderItsName) {
  MachineModel model = test::lai_machine();
  model.joints[0].name = "X-1";
  const std::string text = limit_shares_type(model).text;
  EXPECT_NE(text.find("meridian_msgs/Shares x_1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("MSG: meridian_msgs/Shares\n"), std::string::npos) << text;
}

TEST(MessageTypes, MakeNamesOfFieldsThatNoTwoJointsShare) {
  EXPECT_EQ(
      field_names({"X", "x", "2nd", "θ", "a b", "header", ""}),
      (std::vector<std::string>{"x", "x_2", "joint_2nd", "joint___", "a_b", "header_2", "joint_"}));
}

TEST(MessageTypes, HaveNoFieldForWhatARecordingDoesNotTell) {
  const MachineModel model = test::lai_machine();
  Contents wire{.has_velocity = false, .has_state = false};
  const std::string min_text = cycle_type(model, wire).text;
  for (const char* const word : {"STATE_", "ALARM_", "Velocities", "Feedback", "lateness"}) {
    EXPECT_EQ(min_text.find(word), std::string::npos) << word;
  }
  const std::string usual = cycle_type(model, {}).text;
  EXPECT_NE(usual.find("uint8 STATE_FAULT_STOP=12\n"), std::string::npos);
  EXPECT_NE(usual.find("uint8 KIND_UNWIND=4\nuint8 kind\n"), std::string::npos);
  EXPECT_NE(usual.find("MSG: meridian_msgs/Velocities\n"), std::string::npos);
  wire.has_feedback = true;
  EXPECT_EQ(drives_type(model, wire).text.find("statusword"), std::string::npos);
  wire.has_statuswords = true;
  EXPECT_NE(drives_type(model, wire).text.find("uint16 statusword"), std::string::npos);
}

}  // namespace
}  // namespace meridian::ros
