// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <string>

#include "integration/plant.hpp"

/// Two processes that report the same drives.
namespace meridian::test {
namespace {

class Sources : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> drives_command() {
    return {"meridian", "drives", "--machine", plant.machine(), "--domain", plant.domain()};
  }
  [[nodiscard]] bool is_in_log(const std::string& text) {
    return eventually([&] { return plant.service().said().find(text) != std::string::npos; });
  }
  Plant plant;
};

TEST_F(Sources, OfOneDriveAreRefusedByNameButForTheStopInputOfEach) {
  plant.start_service();
  Process& first = plant.start_drives();
  const std::string own = "process " + std::to_string(first.pid());
  ASSERT_TRUE(plant.enable()) << plant.service().said();

  Process refused(drives_command(), plant.folder() / "refused.log");
  EXPECT_EQ(refused.wait(milliseconds(5000)), 4) << refused.said();
  EXPECT_NE(refused.said().find("b3, b2, b4, theta1, theta2 of machine lai are reported by " + own),
            std::string::npos)
      << refused.said();

  InputPipe console;
  auto command = drives_command();
  command.insert(command.end(), {"--beside-others", "--console"});
  Process second(command, plant.folder() / "second.log", &console);
  EXPECT_TRUE(is_in_log("two report b3, b2, b4, theta1, theta2: drive group 0 of " + own))
      << plant.service().said();
  EXPECT_TRUE(is_in_log("drive group 0 of process " + std::to_string(second.pid())));
  EXPECT_EQ(plant.status().state, State::kReady) << "what it says is passed over";

  console.write("emergency\n");
  ASSERT_TRUE(plant.wait_for(State::kFault)) << plant.standing();
  EXPECT_EQ(plant.status().alarm, Alarm::kEmergencyStop);
  const auto reset = plant.say(Verb::kReset);
  ASSERT_TRUE(reset);
  EXPECT_EQ(reset->refusal, Refusal::kFaultPresent) << reset->text;

  console.write("mend\n");
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kReset, 0, Refusal::kFaultPresent));
  ASSERT_TRUE(plant.wait_for(State::kOff));
  const auto enable = plant.say(Verb::kEnable);
  ASSERT_TRUE(enable);
  EXPECT_EQ(enable->refusal, Refusal::kDriveContested) << enable->text;
  EXPECT_TRUE(enable->text.ends_with("b3, b2, b4, theta1, theta2")) << enable->text;
  second.send_signal(SIGKILL);
  EXPECT_TRUE(plant.enable()) << plant.standing();
}

}  // namespace
}  // namespace meridian::test
