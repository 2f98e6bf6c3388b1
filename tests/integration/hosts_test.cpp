// SPDX-License-Identifier: Apache-2.0
#include "integration/hosts.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "integration/live_run.hpp"

/// Service, drives, station and viewer on hosts of their own, by configuration alone; their
/// monotonic clocks are days apart.
namespace meridian::test {
namespace {

class SeveralHosts : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = Hosts::why_not(); !why.empty()) GTEST_SKIP() << why;
  }
  void use(Hosts::Wire wire) {
    hosts = std::make_unique<Hosts>(wire);
    plant = std::make_unique<Plant>();
  }
  [[nodiscard]] std::string write_part(int blocks) const {
    const std::string part = (plant->folder() / "part.cls").string();
    write_cl_file(part, blocks);
    return part;
  }
  std::unique_ptr<Hosts> hosts;  ///< outlives what runs on them
  std::unique_ptr<Plant> plant;
};

TEST_F(SeveralHosts, CutAProgramAsSimulatedAndAViewerThatNoConfigurationNamesSeesIt) {
  use(Hosts::Wire::kBridge);
  LiveRun live;
  live.wire = (plant->folder() / "wire.csv").string();
  run_and_check(*plant, write_part(8), live);
  expect_on_wire(*plant, live);
}

TEST_F(SeveralHosts, CutAProgramAsSimulatedOverAWireThatLosesDoublesDelaysSwapsAndSpoils) {
  use(Hosts::Wire::kSpoilt);
  hosts->spoil(
      {.delay_ms = 2, .jitter_ms = 1, .lost = 2, .twice = 2, .past_others = 2, .wrong = 1});
  run_and_check(*plant, write_part(8), {});
  const std::string said = hosts->wire_said();
  std::printf("%s", said.c_str());
  int frames = 0, lost = 0, twice = 0, past_others = 0, wrong = 0;
  ASSERT_EQ(
      std::sscanf(said.c_str(), "%d frames, %d lost, %d twice, %d past others, %d with a wrong bit",
                  &frames, &lost, &twice, &past_others, &wrong),
      5)
      << said;
  EXPECT_GT(frames, 5000);
  for (const int count : {lost, twice, past_others, wrong}) EXPECT_GT(count, frames / 200) << said;
}

TEST_F(SeveralHosts, StarveOnThePathWhereTheStationsNetworkIsCutAndGoOnFromThere) {
  use(Hosts::Wire::kBridge);
  plant->start_service({"--service", service_file(*plant)});
  plant->start_drives();
  ASSERT_TRUE(plant->enable()) << plant->service().said();
  const std::string part = write_part(12);
  std::stringstream all;
  all << std::ifstream(part).rdbuf();
  const std::string text = all.str();
  std::size_t third = 0;  // where the third block begins: the less is there, the sooner it starves
  for (int n = 0; n < 3; ++n) third = text.find("GOTO", third + 1);
  ASSERT_NE(third, std::string::npos);
  InputPipe pipe;
  Process station({"meridian", "stream", "-", "--domain", plant->domain(), "--wait-end"},
                  plant->folder() / "station.log", &pipe);
  pipe.write(text.substr(0, third));
  ASSERT_TRUE(plant->wait_for(State::kLoaded)) << station.said();
  ASSERT_NO_FATAL_FAILURE(plant->must(Verb::kStart));
  hosts->cut(Hosts::kStation);
  pipe.write(text.substr(third));
  pipe.close();
  // It may starve with blocks in hand first: these are planned when none has followed for a while.
  ASSERT_TRUE(plant->runs_until(
      [](const dds::Status& status) {
        return status.state == State::kStarved && status.blocks_done == status.blocks_received &&
               status.message.find("is gone") != std::string::npos;
      },
      milliseconds(15'000)))
      << plant->standing() << plant->service().said();
  const dds::Status starved = plant->status();
  EXPECT_EQ(starved.alarm, Alarm::kNone);
  EXPECT_LT(starved.blocks_received, 4U) << "the cut came too late";
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_EQ(plant->status().joints, starved.joints);

  hosts->mend(Hosts::kStation);
  const auto has_ended = [&station] { return station.wait(milliseconds(0)).has_value(); };
  ASSERT_TRUE(plant->runs_until(
      [&](const dds::Status& status) {
        return status.blocks_received > starved.blocks_received || has_ended();
      },
      milliseconds(10'000)))
      << station.said() << plant->standing();
  ASSERT_TRUE(plant->runs_until(
      [&](const dds::Status& status) {
        if (status.state == State::kStarved) (void)plant->say(Verb::kResume);
        return has_ended();
      },
      milliseconds(20'000)))
      << station.said() << plant->standing();
  ASSERT_EQ(station.wait(milliseconds(0)), 0) << station.said() << plant->service().said();
  plant->service().send_signal(SIGTERM);
  ASSERT_EQ(plant->service().wait(milliseconds(5000)), 0) << plant->service().said();
  expect_checked(*plant, part, {});
}

TEST_F(SeveralHosts, FaultWhereTheDrivesNetworkIsCutAndRunAgainWhereItIsMended) {
  use(Hosts::Wire::kBridge);
  plant->start_service();
  plant->start_drives();
  ASSERT_TRUE(plant->enable()) << plant->service().said();
  const auto is_complete = [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  };
  ASSERT_TRUE(plant->stream(small_program(40, 500), is_complete)) << plant->station().message();
  ASSERT_TRUE(plant->wait_for(State::kLoaded));
  ASSERT_NO_FATAL_FAILURE(plant->must(Verb::kStart));
  ASSERT_TRUE(plant->wait_for(State::kRunning));
  hosts->cut(Hosts::kDrives);
  ASSERT_TRUE(plant->wait_for(State::kFault)) << plant->service().said();
  EXPECT_EQ(plant->status().alarm, Alarm::kFeedbackLost);
  hosts->mend(Hosts::kDrives);
  // Left alone the drives ramped down by their watchdog; reset reaches them once they are back.
  ASSERT_TRUE(eventually(
      [&] {
        const auto reset = plant->say(Verb::kReset);
        const auto enable = plant->say(Verb::kEnable);
        return reset && enable && plant->wait_for(State::kReady, milliseconds(500));
      },
      milliseconds(15'000)))
      << plant->service().said();
  ASSERT_TRUE(plant->stream(small_program(3, 3000), is_complete)) << plant->station().message();
  ASSERT_TRUE(plant->wait_for(State::kLoaded)) << plant->standing();
  ASSERT_NO_FATAL_FAILURE(plant->must(Verb::kStart));
  EXPECT_TRUE(plant->stream_on([](const stream::Station& station) { return station.is_over(); },
                               milliseconds(20'000)));
  EXPECT_EQ(plant->station().state(), stream::StationState::kRan) << plant->station().message();
}

TEST_F(SeveralHosts, ServeTwoMachinesInOneDomainBesideEachOther) {
  use(Hosts::Wire::kBridge);
  Plant other("trunnion-ac", *plant);
  const auto cut = [](Plant& of, const std::string& machine) {
    LiveRun live;
    live.machine = machine;
    const std::string part = (of.folder() / "part.cls").string();
    write_cl_file(part, 6, machine);
    const std::string simulated = simulate_part(of, part, live);
    ASSERT_NO_FATAL_FAILURE(run_live(of, part, live));
    expect_same(of, simulated);
  };
  std::thread beside([&] { cut(other, "trunnion-ac"); });
  cut(*plant, "lai");
  beside.join();
}

TEST(HostOfAProgram, ThatIsNotThereEndsTheProgramInsteadOfRunningItBesideTheTest) {
  const Plant plant;
  const HostEnvironment nowhere{.network = "/run/netns/meridian-nowhere", .dds = {}};
  Process::host_of = [&](const auto&) { return &nowhere; };
  Process program({"meridian", "--version"}, plant.folder() / "nowhere.log");
  Process::host_of = nullptr;
  EXPECT_EQ(program.wait(milliseconds(5000)), 126) << program.said();
}

TEST_F(SeveralHosts, WhereTwoServeOneMachineTheLaterGivesWayOnceTheyHearOfEachOther) {
  use(Hosts::Wire::kBridge);
  Process& first = plant->start_service();
  ASSERT_GT(plant->status().service_id, 0U) << first.said();
  hosts->cut(Hosts::kStation);
  hosts->move("meridiand", Hosts::kStation);
  const auto second = plant->another_service();
  ASSERT_TRUE(
      eventually([&] { return second->said().find("answering in Off") != std::string::npos; },
                 milliseconds(6000)))
      << second->said();
  hosts->mend(Hosts::kStation);
  EXPECT_EQ(second->wait(milliseconds(10'000)), 1);
  EXPECT_NE(second->said().find("'lai' is served already"), std::string::npos) << second->said();
  EXPECT_FALSE(first.wait(milliseconds(200))) << "the first goes on: " << first.said();
}

}  // namespace
}  // namespace meridian::test
