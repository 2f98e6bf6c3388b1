// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "integration/plant.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"

/// A guard of the work space, and the monitoring, with real processes.
namespace meridian::test {
namespace {

/// The largest velocity of joint 0 in state Jogging, mm/s.
[[nodiscard]] double fastest_jog(const Plant& plant) {
  const MachineModel model = config::load_machine(plant.machine());
  auto reader = record::RecordingReader::open(plant.recording().string(), model);
  double fastest = 0, last = 0;
  std::uint64_t cycle = 0;
  for (record::RecordingRow row; reader;) {
    const auto has_row = reader->next(row);
    if (!has_row || !*has_row) break;
    const double dt = 1e-9 * static_cast<double>(model.cycle_ns);
    if (row.state == State::kJogging && row.cycle == cycle + 1) {
      fastest = std::max(fastest, (row.joints[0] - last) / dt);
    }
    cycle = row.cycle;
    last = row.joints[0];
  }
  return fastest;
}

/// Service, drives that `console` speaks to, and a program that runs.
void run_a_program(Plant& plant, InputPipe& console) {
  plant.start_service();
  plant.start_drives({}, &console);
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  ASSERT_TRUE(plant.stream(small_program(60, 100), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  }));
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.standing();
}

TEST(OpenGuard, HoldsTheProgramRefusesToGoOnAndLetsTheHandMoveSlowly) {
  Plant plant;
  InputPipe console;
  ASSERT_NO_FATAL_FAILURE(run_a_program(plant, console));
  console.write("guard\n");
  EXPECT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  EXPECT_TRUE(eventually([&] {
    return plant.status().message.find("a guard is open") != std::string::npos;
  })) << plant.status().message;
  EXPECT_TRUE(plant.status().is_guard_open);
  const auto resume = plant.say(Verb::kResume);
  ASSERT_TRUE(resume);
  EXPECT_EQ(resume->refusal, Refusal::kGuardOpen) << resume->text;

  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
  Process hand({"meridian", "ctl", "jog", "b3", "200", "--for", "0.8", "--domain", plant.domain(),
                "--machine-name", "lai"},
               plant.folder() / "ctl.log");
  ASSERT_TRUE(plant.wait_for(State::kJogging)) << hand.said();
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
  EXPECT_EQ(plant.status().alarm, Alarm::kNone);
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(8000)), 0) << plant.service().said();
  const double fastest = fastest_jog(plant);
  EXPECT_GT(fastest, 20);
  EXPECT_LT(fastest, 2000.0 / 60) << "2 m/min";
}

TEST(OpenGuard, LetsTheProgramGoOnOnceItIsShut) {
  Plant plant;
  InputPipe console;
  ASSERT_NO_FATAL_FAILURE(run_a_program(plant, console));
  console.write("guard\n");
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  console.write("mend\n");
  EXPECT_TRUE(eventually([&] { return plant.status().message == "the guard is shut"; }))
      << plant.status().message;
  EXPECT_FALSE(plant.status().is_guard_open);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume, 0, Refusal::kGuardOpen));
  EXPECT_TRUE(plant.wait_for(State::kRunning)) << plant.standing();
}

TEST(Monitoring, StopsAMachineThatCreepsWhereItIsToStand) {
  Plant plant;
  InputPipe console;
  plant.start_service();
  plant.start_drives({}, &console);
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  std::this_thread::sleep_for(milliseconds(800));
  EXPECT_EQ(plant.status().alarm, Alarm::kNone);
  console.write("creep:b2=5\n");
  EXPECT_TRUE(plant.wait_for(State::kFault)) << plant.standing();
  EXPECT_EQ(plant.status().alarm, Alarm::kStandstill);
  EXPECT_EQ(plant.status().alarm_joint, 1);
}

}  // namespace
}  // namespace meridian::test
