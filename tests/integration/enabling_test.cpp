// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "integration/plant.hpp"

/// The enabling device: a process whose silence holds the machine.
namespace meridian::test {
namespace {

class Enabling : public testing::Test {
 protected:
  void start(bool is_required) {
    const auto file = plant_.folder() / "service.toml";
    std::ofstream(file) << "[service]\nmachine = \"" << plant_.machine()
                        << "\"\ndeadman = " << (is_required ? "true" : "false") << "\n";
    plant_.start_service({"--service", file.string()});
    plant_.start_drives();
    ASSERT_TRUE(plant_.enable()) << plant_.service().said();
  }
  void press() {
    device_ = std::make_unique<Process>(
        std::vector<std::string>{"meridian", "enabling", "--domain", plant_.domain(),
                                 "--machine-name", "lai", "--operator", "anna"},
        plant_.folder() / "device.log");
    ASSERT_TRUE(eventually([this] { return plant_.status().enabling_devices == 1; }))
        << device_->said();
  }
  void run_program() {
    ASSERT_TRUE(plant_.stream(small_program(60, 100), [](const stream::Station& station) {
      return station.state() == stream::StationState::kComplete;
    }));
    ASSERT_TRUE(plant_.wait_for(State::kLoaded)) << plant_.standing();
    ASSERT_NO_FATAL_FAILURE(plant_.must(Verb::kStart));
    ASSERT_TRUE(plant_.wait_for(State::kRunning)) << plant_.standing();
  }
  Plant plant_;
  std::unique_ptr<Process> device_;
};

TEST_F(Enabling, IsRequiredBeforeAnythingMoves) {
  ASSERT_NO_FATAL_FAILURE(start(true));
  ASSERT_TRUE(plant_.stream(small_program(60, 100), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  }));
  ASSERT_TRUE(plant_.wait_for(State::kLoaded)) << plant_.standing();
  const auto start = plant_.say(Verb::kStart);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->refusal, Refusal::kNoEnablingDevice) << start->text;
  ASSERT_NO_FATAL_FAILURE(press());
  ASSERT_NO_FATAL_FAILURE(plant_.must(Verb::kStart));
  EXPECT_TRUE(plant_.wait_for(State::kRunning)) << plant_.standing();
}

TEST_F(Enabling, HoldsTheMachineWhereItsProcessIsKilledStoppedOrReleased) {
  ASSERT_NO_FATAL_FAILURE(start(false));
  ASSERT_NO_FATAL_FAILURE(press());
  ASSERT_NO_FATAL_FAILURE(run_program());
  for (const int signal : {SIGSTOP, SIGKILL, SIGINT}) {
    device_->send_signal(signal);
    EXPECT_TRUE(plant_.wait_for(State::kHeld, milliseconds(3000)))
        << signal << ": " << plant_.standing();
    const std::string why = signal == SIGINT ? "anna was released" : "anna fell silent";
    EXPECT_TRUE(eventually([&] { return plant_.status().message.find(why) != std::string::npos; }))
        << plant_.status().message;
    if (signal == SIGINT) break;
    device_->send_signal(SIGKILL);
    ASSERT_NO_FATAL_FAILURE(press());
    ASSERT_NO_FATAL_FAILURE(plant_.must(Verb::kResume));
    ASSERT_TRUE(plant_.wait_for(State::kRunning)) << plant_.standing();
  }
}

TEST(OpenNetwork, IsRefusedByServiceDrivesAndPanelUnlessItIsAllowed) {
  Plant plant;
  const auto xml = plant.folder() / "all.xml";
  std::ofstream(xml) << "<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>false"
                        "</AllowMulticast></General></Domain></CycloneDDS>";
  const std::string uri = "file://" + xml.string();
  ::setenv("CYCLONEDDS_URI", uri.c_str(), 1);
  Process service(
      {"meridiand", "--machine", plant.machine(), "--domain", plant.domain(), "--best-effort"},
      plant.folder() / "refused.log");
  Process drives({"meridian", "drives", "--machine", plant.machine(), "--domain", plant.domain()},
                 plant.folder() / "refused_drives.log");
  Process panel({"meridian", "panel", "--port", "0", "--domain", plant.domain()},
                plant.folder() / "refused_panel.log");
  ::unsetenv("CYCLONEDDS_URI");
  EXPECT_EQ(service.wait(milliseconds(5000)), 1) << service.said();
  EXPECT_NE(service.said().find("open_network = true"), std::string::npos) << service.said();
  const auto code = drives.wait(milliseconds(5000));
  ASSERT_TRUE(code) << drives.said();
  EXPECT_NE(*code, 0);
  EXPECT_NE(drives.said().find("--open-network"), std::string::npos) << drives.said();
  ASSERT_NE(panel.wait(milliseconds(5000)).value_or(0), 0) << panel.said();
  if (panel.said().find("not expected") != std::string::npos) GTEST_SKIP() << "without the panel";
  EXPECT_NE(panel.said().find("--open-network"), std::string::npos) << panel.said();
}

}  // namespace
}  // namespace meridian::test
