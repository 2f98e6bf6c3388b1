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

/// After a fault: the session is over; the status still holds where the machine came to rest.
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

TEST(StatusText, ShowsAlarmJointLineAndTheBlockInWhichTheMachineRests) {
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

TEST(StatusText, ShowsAGuardAsLongAsItIsOpen) {
  dds::Status status;
  EXPECT_EQ(describe(status, machine_of_a_stage()).find("guard"), std::string::npos);
  EXPECT_NE(to_json(status, machine_of_a_stage()).find("\"guard_open\":false"), std::string::npos);
  status.is_guard_open = true;
  EXPECT_NE(describe(status, machine_of_a_stage()).find("\nguard     open"), std::string::npos);
  EXPECT_NE(to_json(status, machine_of_a_stage()).find("\"guard_open\":true"), std::string::npos);
}

TEST(StatusText, ShowsNoAlarmWhereThereIsNone) {
  dds::Status status = faulty_status();
  status.alarm = Alarm::kNone;
  const std::string text = describe(status, machine_of_a_stage());
  EXPECT_EQ(text.find("alarm"), std::string::npos) << text;
  EXPECT_EQ(text.find("block     "), std::string::npos) << text;
}

TEST(StatusText, ShowsWhatHoldsTheFeedAndWhereTheToolIs) {
  const dds::MachineInfo machine = machine_of_a_stage();
  dds::Status status;
  status.limiting_joint = -1;
  EXPECT_EQ(describe(status, machine).find("held by"), std::string::npos);
  EXPECT_EQ(describe(status, machine).find("tool  "), std::string::npos);
  status.limiting_joint = 2;
  const std::string text = describe(status, machine, Pose<double>{{1, -2, 3.5}, {0, 0.6, 0.8}});
  EXPECT_NE(text.find("\nheld by   u1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\ntool      tip 1.0000 -2.0000 3.5000 mm, axis 0.000000 0.600000 0.800000,"),
            std::string::npos)
      << text;
}

TEST(StatusText, ReportsTheSoftLimits) {
  dds::MachineInfo machine = machine_of_a_stage();
  machine.joints[1].is_rotary = true;
  EXPECT_EQ(describe({}, machine).find("limits "), std::string::npos);
  EXPECT_NE(to_json({}, machine).find(",\"soft_limits\":{},"), std::string::npos);
  machine.soft_limits.put(1, 0, 0.5);
  EXPECT_NE(describe({}, machine).find("\nlimits    b2 0 to 28.64788976 deg\n"), std::string::npos);
  machine.soft_limits.put(0, -40, 42.5);
  EXPECT_NE(describe({}, machine).find("\nlimits    b3 -40 to 42.5 mm, b2 0 to 28.64788976 deg\n"),
            std::string::npos)
      << describe({}, machine);
  EXPECT_NE(
      to_json({}, machine).find(",\"soft_limits\":{\"b3_mm\":[-40,42.5],\"b2_rad\":[0,0.5]},"),
      std::string::npos)
      << to_json({}, machine);
}

TEST(StatusText, ShowsTheTimeToGo) {
  const dds::MachineInfo machine = machine_of_a_stage();
  dds::Status status;
  status.state = State::kRunning;
  status.block_count = 200;
  status.blocks_received = 200;
  status.planned_s = 41.2;
  EXPECT_NE(describe(status, machine).find("\nto go     0:42 at 100 %\n"), std::string::npos);
  status.blocks_queued = 10;  // not all is planned: by the share of blocks
  status.block = 50;
  status.plan_time_s = 20;
  EXPECT_NE(describe(status, machine).find("\nto go     about 1:00 at 100 %\n"), std::string::npos);
  status.block = 0;
  EXPECT_FALSE(time_to_go(status)) << "nothing has run to estimate from";
  status.block = 50;
  status.state = State::kLoaded;
  EXPECT_FALSE(time_to_go(status)) << "nothing runs";
}

TEST(StatusText, SaysTheSameToPrograms) {
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
  EXPECT_NE(text.find("\"limiting\":\"\",\"tip_mm\":null,\"tool_axis\":null,"), std::string::npos)
      << text;
  status.limiting_joint = 1;
  text = to_json(status, machine_of_a_stage(), Pose<double>{{1, 2, 3.5}, {0, 0, 1}});
  EXPECT_NE(text.find("\"limiting\":\"b2\",\"tip_mm\":[1,2,3.5],\"tool_axis\":[0,0,1],"),
            std::string::npos)
      << text;
  status.alarm = Alarm::kEmergencyStop;
  text = to_json(status, machine_of_a_stage());
  EXPECT_NE(text.find("\"alarm_name\":\"emergency_stop\",\"alarm_joint\":\"\","), std::string::npos)
      << text;
}

}  // namespace
}  // namespace meridian::cli
