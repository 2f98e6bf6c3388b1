// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "integration/plant.hpp"

/// Somebody else commands the drives: a process of its own that knows the wire types and nothing
/// else of this project (stranger.c).
namespace meridian::test {
namespace {

class OneMaster : public testing::Test {
 protected:
  /// A stranger is no real-time program: the drives bridge what a busy host makes it miss.
  OneMaster() { plant.change_machine({{"bridge_cycles = [0-9]+", "bridge_cycles = 100"}}); }
  std::unique_ptr<Process> stranger(const std::string& how, std::uint64_t service_id,
                                    double seconds) {
    return std::make_unique<Process>(
        std::vector<std::string>{"stranger", plant.domain(), "lai", how, std::to_string(service_id),
                                 std::to_string(seconds)},
        plant.folder() / ("stranger-" + how + ".log"));
  }
  /// Lets the stranger work to its end; how far drive 0 moved meanwhile, by its own report.
  double moved_by(Process& process) {
    EXPECT_TRUE(process.wait(milliseconds(20'000)));
    double from = 0, to = 1e9;
    const std::string said = process.said();
    const std::size_t at = said.find("drive 0 from");
    EXPECT_NE(at, std::string::npos) << said;
    if (at == std::string::npos) return to;
    EXPECT_EQ(std::sscanf(said.c_str() + at, "drive 0 from %lf to %lf", &from, &to), 2) << said;
    return std::abs(to - from);
  }
  [[nodiscard]] bool is_said(Process& process, const std::string& text,
                             milliseconds patience = milliseconds(8000)) {
    return eventually([&] { return process.said().find(text) != std::string::npos; }, patience);
  }

  Plant plant;
};

TEST_F(OneMaster, AStrangerWhoQuotesTheServiceIdMovesNothingInOffReadyAndFaultAndIsNamed) {
  plant.start_service();
  Process& drives = plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.standing();
  const std::uint64_t id = plant.status().service_id;
  const auto in_ready = stranger("forged", id, 2);
  EXPECT_EQ(moved_by(*in_ready), 0);
  EXPECT_EQ(plant.status().state, State::kReady) << plant.standing();
  const std::string own = "process " + std::to_string(in_ready->pid());
  EXPECT_TRUE(is_said(drives, "drive commands of " + own)) << drives.said();
  EXPECT_TRUE(is_said(drives, "setpoints of " + own)) << drives.said();

  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kDisable));
  ASSERT_TRUE(plant.wait_for(State::kOff)) << plant.standing();
  EXPECT_EQ(moved_by(*stranger("forged", id, 2)), 0);
  EXPECT_EQ(plant.status().state, State::kOff) << plant.standing();
  EXPECT_TRUE(plant.enable()) << "the service is their master as before: " << plant.standing();
}

TEST_F(OneMaster, AStrangerMovesNothingBehindAFaultStop) {
  InputPipe console;
  plant.start_service();
  plant.start_drives({}, &console);
  ASSERT_TRUE(plant.enable()) << plant.standing();
  console.write("emergency\n");
  ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.standing();
  EXPECT_EQ(moved_by(*stranger("forged", plant.status().service_id, 2)), 0);
  EXPECT_EQ(plant.status().alarm, Alarm::kEmergencyStop) << plant.standing();
  EXPECT_EQ(plant.status().drives_enabled_mask, 0U);
}

TEST_F(OneMaster, AFakeServiceThatCameBeforeIsReportedAndTheMachineIsNotEnabled) {
  plant.start_drives();
  const auto fake = stranger("spoilt", 4711, 8);  // it has the drives, and leads them nowhere
  std::this_thread::sleep_for(milliseconds(1000));
  Process& service = plant.start_service();
  ASSERT_GT(plant.status().service_id, 0U) << service.said();
  EXPECT_TRUE(is_said(service, "obeys service 0000000000001267, not this one")) << service.said();
  EXPECT_TRUE(is_said(service, "process " + std::to_string(fake->pid()))) << service.said();
  const auto enable = plant.say(Verb::kEnable);
  ASSERT_TRUE(enable);
  EXPECT_FALSE(enable->is_accepted);
  fake->send_signal(SIGKILL);
  ASSERT_TRUE(fake->wait(milliseconds(2000)));
  EXPECT_TRUE(eventually(
      [&] {
        (void)plant.say(Verb::kReset);
        return plant.enable();
      },
      milliseconds(15'000)))
      << plant.standing();
}

TEST_F(OneMaster, DrivesThatMoveInOffAreAnAlarmWhoseResetIsRefusedWhileItLasts) {
  plant.start_drives({"--time-constant", "0"});
  const auto fake = stranger("hold", 4711, 6);  // enables them, and stands
  std::this_thread::sleep_for(milliseconds(1000));
  plant.start_service();
  ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.standing();
  EXPECT_EQ(plant.status().alarm, Alarm::kDrivesAstray) << plant.standing();
  const auto reset = plant.say(Verb::kReset);
  ASSERT_TRUE(reset);
  EXPECT_EQ(reset->refusal, Refusal::kDrivesAstray) << reset->text;
  EXPECT_TRUE(fake->wait(milliseconds(10'000)));
  EXPECT_TRUE(eventually(
      [&] {
        (void)plant.say(Verb::kReset);
        return plant.status().state == State::kOff;
      },
      milliseconds(8000)))
      << plant.standing();
}

TEST_F(OneMaster, AMastersJumpIsRefusedByTheDriveWhichStopsWithItsOwnError) {
  Process& drives = plant.start_drives();
  EXPECT_LT(moved_by(*stranger("jump", 4711, 2)), 0.001);
  EXPECT_TRUE(is_said(drives, "drive b3: fault (error FF04h)")) << drives.said();
}

TEST_F(OneMaster, AMasterBeyondTheVelocityLimitIsRefused) {
  Process& drives = plant.start_drives();
  EXPECT_LT(moved_by(*stranger("master", 4711, 2)), 0.001);
  EXPECT_TRUE(is_said(drives, "drive b3: fault (error FF03h)")) << drives.said();
}

TEST_F(OneMaster, SetpointsWithABadChecksumAreAsIfNoneHadCome) {
  Process& drives = plant.start_drives();
  EXPECT_EQ(moved_by(*stranger("spoilt", 4711, 2)), 0);
  EXPECT_TRUE(is_said(drives, "drive b3: fault (error 8700h)")) << drives.said();
  drives.send_signal(SIGINT);
  EXPECT_TRUE(drives.wait(milliseconds(4000)));
  EXPECT_NE(drives.said().find("setpoints with a bad checksum were dropped"), std::string::npos)
      << drives.said();
}

TEST_F(OneMaster, AServiceThatWasKilledIsFollowedByTheNextOneOnceItsLeaseIsOver) {
  plant.start_drives();
  Process& first = plant.start_service();
  ASSERT_TRUE(plant.enable()) << plant.standing();
  first.send_signal(SIGKILL);
  ASSERT_TRUE(first.wait(milliseconds(2000)));
  plant.start_service();
  ASSERT_NE(plant.status().service_id, 0U);
  (void)eventually([&] { return plant.say(Verb::kReset)->is_accepted; });
  EXPECT_TRUE(plant.enable()) << plant.standing();
}

TEST_F(OneMaster, ANewServiceHasTheDrivesAtOnceWhereTheOneBeforeEndedOrderly) {
  plant.start_drives();
  Process& first = plant.start_service();
  ASSERT_TRUE(plant.enable()) << plant.standing();
  first.send_signal(SIGINT);
  ASSERT_TRUE(first.wait(milliseconds(8000))) << first.said();
  plant.start_service();
  EXPECT_TRUE(plant.enable()) << plant.standing();
}

TEST_F(OneMaster, AServiceThatTheDrivesObeyLeavesForNoClaim) {
  Process& service = plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kDisable));
  ASSERT_TRUE(plant.wait_for(State::kOff));
  EXPECT_TRUE(stranger("claim", 1, 4)->wait(milliseconds(15'000)));
  EXPECT_FALSE(service.wait(milliseconds(500))) << service.said();
}

}  // namespace
}  // namespace meridian::test
