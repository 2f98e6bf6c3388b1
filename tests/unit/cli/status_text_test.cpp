// SPDX-License-Identifier: Apache-2.0
#include "service/cli/status_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace meridian::cli {
namespace {

[[nodiscard]] dds::MachineInfo machine_of_a_stage() {
  dds::MachineInfo machine;
  machine.name = "lai";
  machine.joint_count = 2;
  machine.joints[0].name = "b3";
  machine.joints[1].name = "b2";
  machine.stage_drive_count = 1;
  machine.stage_drives[0].name = "u1";
  return machine;
}

/// Behind a fault: the session is over, where the machine came to rest is told still.
[[nodiscard]] dds::Status faulty_status() {
  dds::Status status;
  status.state = State::kFault;
  status.alarm = Alarm::kFollowingError;
  status.alarm_joint = 1;
  status.alarm_line = 840;
  status.block = 813;
  status.line = 841;
  return status;
}

TEST(StatusText, TellsAlarmJointLineAndTheBlockInWhichTheMachineRests) {
  const dds::MachineInfo machine = machine_of_a_stage();
  dds::Status status = faulty_status();
  std::string text = describe(status, machine);
  EXPECT_NE(text.find("\nalarm     following_error of b2, line 840\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nblock     813, line 841\n"), std::string::npos) << text;
  status.alarm_joint = 2;
  text = describe(status, machine);
  EXPECT_NE(text.find("following_error of u1, line 840\n"), std::string::npos) << text;
  status.alarm_joint = 255;
  status.alarm_line = 0;
  text = describe(status, machine);
  EXPECT_NE(text.find("\nalarm     following_error\n"), std::string::npos) << text;
}

TEST(StatusText, TellsNoAlarmWhereThereIsNone) {
  dds::Status status = faulty_status();
  status.alarm = Alarm::kNone;
  const std::string text = describe(status, machine_of_a_stage());
  EXPECT_EQ(text.find("alarm"), std::string::npos) << text;
  EXPECT_EQ(text.find("block     "), std::string::npos) << text;
}

TEST(StatusText, TellsProgramsTheSame) {
  dds::Status status = faulty_status();
  std::string text = to_json(status, machine_of_a_stage());
  EXPECT_NE(
      text.find("\"alarm_name\":\"following_error\",\"alarm_joint\":\"b2\",\"alarm_line\":840,"),
      std::string::npos)
      << text;
  status.alarm = Alarm::kNone;
  text = to_json(status, machine_of_a_stage());
  EXPECT_NE(text.find("\"alarm_joint\":\"\",\"alarm_line\":0,"), std::string::npos)
      << "that of the last alarm is none: " << text;
  status.alarm = Alarm::kEmergencyStop;
  text = to_json(status, machine_of_a_stage());
  EXPECT_NE(text.find("\"alarm_name\":\"emergency_stop\",\"alarm_joint\":\"\","), std::string::npos)
      << text;
}

}  // namespace
}  // namespace meridian::cli
