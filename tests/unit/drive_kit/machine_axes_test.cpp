// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/machine_axes.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "unit/drive_kit/scripted_hardware.hpp"

namespace meridian::drive {
namespace {

Options of_file() {
  Options options;
  options.machine_file = MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml";
  return options;
}
Options by_hand() {
  Options options;
  options.machine = "mill";
  options.cycle_ns = 1'000'000;
  options.axes.resize(2);
  options.axes[0].name = "X";
  options.axes[1].name = "Y";
  return options;
}

TEST(MachineAxes, EverythingIsTakenFromTheMachineFile) {
  const Options options = complete(of_file());
  EXPECT_EQ(options.machine, "lai");
  ASSERT_EQ(options.axes.size(), 5U);
  EXPECT_EQ(options.axes[4].joint, 4);
  EXPECT_GT(options.axes[0].velocity, 0);
  EXPECT_GT(options.axes[0].fault_acceleration, 0);
  EXPECT_GT(options.cycle_ns, 0);
  EXPECT_GT(options.bridge_cycles, 0);
  EXPECT_EQ(options.machine_joints, 5);
}

TEST(MachineAxes, WhatIsGivenIsNotOverwritten) {
  Options asked = of_file();
  asked.machine = "other";
  asked.axes.resize(1);
  asked.axes[0].name = "turret";
  asked.axes[0].joint = 3;
  const Options options = complete(asked);
  EXPECT_EQ(options.machine, "other");
  ASSERT_EQ(options.axes.size(), 1U);
  EXPECT_EQ(options.machine_joints, 5) << "others have the rest";
}

TEST(MachineAxes, WithoutAFileTheListIsTheMachine) {
  const Options options = complete(by_hand());
  EXPECT_EQ(options.axes[1].joint, 1);
  EXPECT_EQ(options.machine_joints, 2);
  EXPECT_EQ(options.bridge_cycles, 3);
}

TEST(MachineAxes, WhatCannotBeIsRefusedWithTheReason) {
  struct Row {
    const char* reason;
    std::function<void(Options&)> spoil;
  };
  const Row rows[] = {
      {"no machine", [](Options& o) { o.machine.clear(); }},
      {"no axes", [](Options& o) { o.axes.clear(); }},
      {"cycle_ns is 0", [](Options& o) { o.cycle_ns = 0; }},
      {"bridge_cycles is negative", [](Options& o) { o.bridge_cycles = -1; }},
      {"another axis has joint 0", [](Options& o) { o.axes[1].joint = 0; }},
      {"joint is 6", [](Options& o) { o.axes[1].joint = 6; }},
      {"a limit is no number", [](Options& o) { o.axes[0].velocity = -1; }},
      {"travel or homing is no number",
       [](Options& o) { o.axes[0].travel_max = std::numeric_limits<double>::infinity(); }},
      {"needs search_velocity",
       [](Options& o) { o.axes[0].homing.method = HomingMethod::kByIndex; }},
      {"search_velocity is beyond",
       [](Options& o) {
         o.axes[0].velocity = 10;
         o.axes[0].homing.search_velocity = -11;
       }},
      {"nowhere.toml", [](Options& o) { o.machine_file = "nowhere.toml"; }},
  };
  for (const Row& row : rows) {
    Options options = by_hand();
    row.spoil(options);
    try {
      (void)complete(options);
      ADD_FAILURE() << "accepted: " << row.reason;
    } catch (const DriveError& error) {
      EXPECT_NE(std::string(error.what()).find(row.reason), std::string::npos) << error.what();
    }
  }
}

TEST(MachineAxes, AxesStandWhereTheHardwareReadsThem) {
  test::ScriptedHardware motors;
  motors.readings[1].position = 42;
  const GroupSpec group = group_of(complete(by_hand()), motors);
  EXPECT_EQ(group.axes[1].position, 42);
  motors.readings[1].position = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)group_of(complete(by_hand()), motors), DriveError);
}

}  // namespace
}  // namespace meridian::drive
