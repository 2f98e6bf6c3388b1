// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>

#include "integration/plant.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/flight/flight_report.hpp"

namespace meridian::test {
namespace {

using stream::Station;
using stream::StationState;

class Fault : public testing::Test {
 protected:
  /// Runs a slow program with `drives` on the drives' command line.
  void run_with(const std::vector<std::string>& drives) {
    plant.start_service();
    plant.start_drives(drives);
    ASSERT_TRUE(plant.enable()) << plant.service().said();
    ASSERT_TRUE(plant.stream(small_program(60, 500), [](const Station& station) {
      return station.state() == StationState::kComplete;
    })) << plant.station().message();
    ASSERT_TRUE(plant.wait_for(State::kLoaded));
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  }
  void expect_fault(Alarm alarm) {
    ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.service().said();
    EXPECT_EQ(plant.status().alarm, alarm) << plant.service().said();
    EXPECT_NE(plant.service().said().find("-> FaultStop"), std::string::npos);
  }
  /// The file of the flight recorder, which comes when the machine has been at rest for a while.
  std::filesystem::path wait_for_flight() {
    std::filesystem::path found;
    EXPECT_TRUE(eventually([&] {
      for (const auto& entry : std::filesystem::recursive_directory_iterator(plant.faults())) {
        if (entry.path().extension() == ".csv") found = entry.path();
      }
      return !found.empty();
    })) << plant.service().said();
    return found;
  }
  void expect_recovery() {
    ASSERT_TRUE(eventually([&] {
      const auto reset = plant.say(Verb::kReset);
      return reset && reset->is_accepted && plant.wait_for(State::kOff, milliseconds(500));
    })) << plant.service().said();
    EXPECT_EQ(plant.status().alarm, Alarm::kNone);
    EXPECT_EQ(plant.status().session, 0U) << "the program is over";
    EXPECT_TRUE(plant.enable()) << plant.service().said();
    std::this_thread::sleep_for(milliseconds(200));
    EXPECT_EQ(plant.status().state, State::kReady) << "nothing of the old program is left";
  }
  Plant plant;
};

TEST_F(Fault, OfADriveStopsNamesTheJointAndIsResetByTheOperator) {
  run_with({"--inject", "fault@2.5:theta2"});
  expect_fault(Alarm::kDriveFault);
  EXPECT_EQ(plant.status().alarm_joint, 4);
  EXPECT_NE(plant.service().said().find("drive theta2 reports a fault"), std::string::npos)
      << plant.service().said();
  EXPECT_GT(plant.status().alarm_line, 0U);
  expect_recovery();
}

TEST_F(Fault, OfAShaftThatIsStuckIsAFollowingError) {
  run_with({"--inject", "blocked@2.5:b3"});
  ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.service().said();
  const Alarm alarm = plant.status().alarm;
  EXPECT_TRUE(alarm == Alarm::kFollowingError || alarm == Alarm::kDriveFault)
      << plant.service().said();

  // The flight recorder has it: the joint, what was sent before and after, the shaft that stays.
  const MachineModel model = config::load_machine(machine_file());
  auto flight = record::RecordingReader::open(wait_for_flight().string(), model);
  ASSERT_TRUE(flight.has_value()) << flight.error().text();
  const auto report = record::read_flight(*flight, model);
  ASSERT_TRUE(report.has_value()) << report.error().text();
  EXPECT_EQ(report->alarm, alarm);
  EXPECT_EQ(model.joints[static_cast<std::size_t>(report->joint)].name, "b3");
  EXPECT_EQ(report->line, plant.status().alarm_line);
  EXPECT_GT(report->before_s, 1.5) << "the machine was enabled 2.5 s before";
  EXPECT_GT(report->after_s, report->stop_s + 0.4) << "the stop and some rest";
  EXPECT_GT(report->stop_s, 0);
  const auto joint = static_cast<std::size_t>(report->joint);
  const double allowed = model.joints[joint].limits.following_error;
  EXPECT_GT(std::abs(report->following[joint].before), 0.5 * allowed) << "feedback departs";
  EXPECT_GT(std::abs(report->following[joint].after), 0.9 * allowed);
  const std::size_t other = joint == 1 ? 2 : 1;
  EXPECT_LT(std::abs(report->following[other].before),
            0.5 * model.joints[other].limits.following_error);
  ASSERT_FALSE(report->turns.empty());
  EXPECT_TRUE(std::any_of(report->turns.begin(), report->turns.end(), [&](const auto& turn) {
    return turn.drive == report->joint && turn.error == 0x8611;
  })) << record::to_text(*report, model);
}

TEST_F(Fault, OfSilentDrivesIsLostFeedback) {
  run_with({"--inject", "silence@2.5"});
  expect_fault(Alarm::kFeedbackLost);
  ASSERT_TRUE(plant.stream(small_program(4, 3000), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  }));
  EXPECT_TRUE(eventually([&] {
    const std::string& message = plant.status().message;
    return message.starts_with("no feedback from drive b3; check") &&
           message.find("4 blocks") != std::string::npos;
  })) << "the reason stays in front of what stations do: "
      << plant.status().message;
}

TEST_F(Fault, OfTheEmergencyInputIsNotResetWhileItIsOpen) {
  run_with({"--inject", "emergency@2.5"});
  expect_fault(Alarm::kEmergencyStop);
  const auto reset = plant.say(Verb::kReset);
  ASSERT_TRUE(reset);
  EXPECT_FALSE(reset->is_accepted);
  EXPECT_EQ(reset->refusal, Refusal::kFaultPresent) << reset->text;
}

TEST_F(Fault, OfTheServiceItselfLeavesAMachineThatWaitsForEnableAndStart) {
  run_with({});
  ASSERT_TRUE(plant.wait_for(State::kRunning));
  // Two seconds and more into it: what the journal says then is at most one second old.
  ASSERT_TRUE(eventually([&] { return plant.status().block >= 6; }, milliseconds(20000)));
  const std::uint64_t first_id = plant.status().service_id;
  const std::uint32_t last_line = plant.status().line;
  plant.service().send_signal(SIGKILL);
  ASSERT_TRUE(plant.service().wait(milliseconds(2000)));
  plant.start_service();
  ASSERT_TRUE(eventually([&] { return plant.status().service_id != first_id; }, milliseconds(6000)))
      << plant.service().said();
  EXPECT_EQ(plant.status().state, State::kOff);
  const std::string message = plant.status().message;
  const std::string go_on = " begun at least; go on with --from-line ";
  EXPECT_EQ(message.rfind("last program: small program, line ", 0), 0U) << message;
  ASSERT_NE(message.find(go_on), std::string::npos) << message;
  const auto next_line = std::stoul(message.substr(message.find(go_on) + go_on.size()));
  EXPECT_LE(next_line, last_line);
  EXPECT_GE(next_line + 5, last_line) << "a block of 2 mm at 500 mm/min takes 0.24 s";
  EXPECT_NE(plant.service().said().find(message + "; noted 2"), std::string::npos);
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start);
  EXPECT_FALSE(start->is_accepted);
  std::this_thread::sleep_for(milliseconds(300));
  const JointVector before = plant.status().joints;
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(plant.status().joints, before) << "nothing moves by itself";
  // Left alone the drives' watchdog took them to fault; the operator resets it in Off.
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kReset));
  EXPECT_TRUE(plant.enable()) << plant.service().said();
}

TEST_F(Fault, OfDrivesThatDieWhileTheServiceEndsIsNoReasonToAskAgainAndAgain) {
  run_with({});
  ASSERT_TRUE(plant.wait_for(State::kRunning));
  plant.drives().send_signal(SIGKILL);
  ASSERT_TRUE(plant.drives().wait(milliseconds(2000)));
  plant.service().send_signal(SIGTERM);
  EXPECT_EQ(plant.service().wait(milliseconds(12000)), 0) << plant.service().said();
  EXPECT_EQ(plant.service().said().find("refused"), std::string::npos) << plant.service().said();
}

TEST_F(Fault, OfDrivesThatDieAtRestIsNoReasonToAskAgainAndAgainEither) {
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  plant.drives().send_signal(SIGSTOP);
  plant.service().send_signal(SIGTERM);
  EXPECT_EQ(plant.service().wait(milliseconds(12000)), 0) << plant.service().said();
  EXPECT_EQ(plant.service().said().find("refused"), std::string::npos) << plant.service().said();
}

TEST(StationFault, LeavesAMachineThatRunsWhatItWasGivenStopsOnThePathAndWaits) {
  Plant plant;
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  const auto program = small_program(24, 2000);
  InputPipe pipe;
  Process station({"meridian", "stream", "-", "--domain", plant.domain()},
                  plant.folder() / "station.log", &pipe);
  pipe.write("PARTNO/PIPE\nUNITS/MM\nFEDRAT/2000,MMPM\n" + cl_text(program));
  ASSERT_TRUE(eventually([&] { return plant.status().blocks_received >= program.size(); }))
      << station.said();
  ASSERT_TRUE(plant.wait_for(State::kLoaded));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.wait_for(State::kRunning));
  station.send_signal(SIGKILL);
  ASSERT_TRUE(station.wait(milliseconds(2000)));

  ASSERT_TRUE(plant.wait_for(State::kStarved, milliseconds(30000))) << plant.service().said();
  const dds::Status starved = plant.status();
  EXPECT_EQ(starved.alarm, Alarm::kNone);
  EXPECT_EQ(starved.block, program.size() - 1) << "every block that was granted is run";
  EXPECT_NE(starved.session, 0U) << "the program is not over";
  const MachineModel model = config::load_machine(machine_file());
  const ToolPose at = forward(model, model.tool_length_mm, starved.joints);
  const Vector3 wanted(program.back().tip_mm.data());
  EXPECT_LT((at.tip - wanted).norm(), 2e-3) << "on the path, at the end of the last block";
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(plant.status().state, State::kStarved) << "it waits for the operator";
  EXPECT_EQ(plant.status().joints, starved.joints);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.service().said();
  EXPECT_TRUE(eventually([&] { return plant.status().session == 0; })) << "the machine is free";
}

}  // namespace
}  // namespace meridian::test
