// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>
#include <thread>

#include "integration/plant.hpp"

namespace meridian::test {
namespace {

using stream::Station;
using stream::StationState;

bool is_complete(const Station& station) { return station.state() == StationState::kComplete; }
bool has_ran(const Station& station) { return station.state() == StationState::kRan; }

class Program : public testing::Test {
 protected:
  void SetUp() override {
    plant.start_service();
    plant.start_drives();
    ASSERT_TRUE(plant.enable()) << plant.service().said();
  }
  Plant plant;
};

TEST_F(Program, RunsFromEnableToEndAndRecordsEveryCycleThatWasSent) {
  const auto blocks = small_program(20, 3000);
  ASSERT_TRUE(plant.stream(
      blocks,
      [&](const Station& station) {
        const dds::Status status = plant.status();
        const bool is_declared = status.message.find("approach to line") != std::string::npos;
        return is_complete(station) && status.state == State::kLoaded && is_declared;
      }))
      << plant.station().message() << plant.service().said();
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start && start->is_accepted) << (start ? start->text : "no reply");
  EXPECT_EQ(start->text.rfind("start accepted; approach to line ", 0), 0U) << start->text;
  ASSERT_TRUE(plant.stream_on(has_ran, milliseconds(20000)))
      << plant.station().message() << plant.service().said();
  EXPECT_TRUE(plant.wait_for(State::kReady));
  // Events and state come to the status by two ways: the last block may be reported a status later.
  EXPECT_TRUE(eventually([&] { return plant.status().blocks_done == blocks.size(); }))
      << plant.status().blocks_done;
  const dds::Status after = plant.status();
  EXPECT_EQ(after.records_overrun + after.events_overrun + after.setpoints_overrun, 0U);

  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kDisable));
  ASSERT_TRUE(plant.wait_for(State::kOff));
  plant.service().send_signal(SIGTERM);
  EXPECT_EQ(plant.service().wait(milliseconds(3000)), 0) << plant.service().said();
  std::ifstream recording(plant.recording());
  std::string line;
  std::uint64_t rows = 0;
  while (std::getline(recording, line)) ++rows;
  EXPECT_GE(rows, after.cycles_run);
}

TEST_F(Program, NeverMovesByBlocksAlone) {
  ASSERT_TRUE(plant.stream(small_program(5, 3000), is_complete));
  ASSERT_TRUE(plant.wait_for(State::kLoaded));
  const JointVector before = plant.status().joints;
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_EQ(plant.status().state, State::kLoaded);
  EXPECT_EQ(plant.status().joints, before);
}

TEST_F(Program, StopsOnThePathAndSwitchesOffWhenTheServiceIsAskedToEnd) {
  ASSERT_TRUE(plant.stream(small_program(40, 500), is_complete));
  ASSERT_TRUE(plant.wait_for(State::kLoaded));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.wait_for(State::kRunning));
  plant.service().send_signal(SIGTERM);
  EXPECT_EQ(plant.service().wait(milliseconds(5000)), 0);
  const std::string said = plant.service().said();
  EXPECT_NE(said.find("-> Aborting"), std::string::npos) << said;
  EXPECT_NE(said.find("-> Off"), std::string::npos) << said;
  EXPECT_EQ(said.find("FaultStop"), std::string::npos) << said;
}

TEST_F(Program, KeepsBlocksThatCameBeforeTheDrivesWereOn) {
  ASSERT_TRUE(plant.say(Verb::kDisable));
  ASSERT_TRUE(plant.wait_for(State::kOff));
  ASSERT_TRUE(plant.stream(small_program(5, 3000), is_complete));
  ASSERT_TRUE(eventually([&] {
    const auto reply = plant.say(Verb::kEnable);
    return reply && reply->is_accepted;
  }));
  EXPECT_TRUE(plant.wait_for(State::kLoaded)) << plant.service().said();
}

TEST_F(Program, RunsASecondProgramAfterTheFirst) {
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(plant.stream(small_program(3, 5000), is_complete)) << plant.station().message();
    ASSERT_TRUE(plant.wait_for(State::kLoaded)) << plant.service().said();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_TRUE(plant.stream_on(has_ran, milliseconds(15000)))
        << plant.station().message() << plant.service().said();
    ASSERT_TRUE(plant.wait_for(State::kReady));
  }
}

}  // namespace
}  // namespace meridian::test
