// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>

#include "integration/plant.hpp"
#include "service/host/probe/budgets.hpp"

namespace meridian::test {
namespace {

[[nodiscard]] double resident_mib(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  std::string word;
  while (file >> word) {
    double kib = 0;
    if (word == "VmRSS:" && file >> kib) return kib / 1024;
  }
  return -1;
}

TEST(Service, AnswersInOffWithinThreeSecondsAndStaysSmall) {
  Plant plant;
  const auto start = std::chrono::steady_clock::now();
  Process& service = plant.start_service();
  ASSERT_EQ(plant.status().state, State::kOff) << service.said();
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double resident = resident_mib(service.pid());
  std::printf("answering in Off after %.3f s, %.1f MiB resident\n", took_s, resident);
  EXPECT_GT(plant.status().service_id, 0U) << service.said();
  EXPECT_LE(took_s, probe::load_budget("start_time").allowed());
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LE(resident, probe::load_budget("resident_memory").allowed());
#endif
}

/// Its drives run already, and the operator enables as soon as it answers.
TEST(Service, IsReadyWithinTwoSecondsOfItsStart) {
  Plant plant;
  plant.start_drives();
  const auto start = std::chrono::steady_clock::now();
  Process& service = plant.start_service();
  ASSERT_TRUE(plant.enable()) << service.said();
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("Ready after %.3f s\n", took_s);
  EXPECT_EQ(plant.status().state, State::kReady) << service.said();
  EXPECT_LE(took_s, probe::load_budget("start_to_ready").allowed());
}

TEST(Service, EndsAtOnceAndCleanlyWhenAskedToInOff) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Plant plant;
    Process& service = plant.start_service();
    ASSERT_GT(plant.status().service_id, 0U) << service.said();
    service.send_signal(signal);
    EXPECT_EQ(service.wait(milliseconds(3000)), 0) << service.said();
  }
}

TEST(Service, RefusesAMachineFileWithFileKeyAndRemedy) {
  Plant plant;
  const std::string path = (plant.folder() / "bad.toml").string();
  std::ofstream(path) << "[machine]\nname = \"bad\"\ncycle_us = -4\n";
  Process service({"meridiand", "--machine", path, "--domain", plant.domain()},
                  plant.folder() / "bad.log");
  EXPECT_EQ(service.wait(milliseconds(3000)), 3);
  const std::string said = service.said();
  EXPECT_NE(said.find("bad.toml:"), std::string::npos) << said;
  EXPECT_NE(said.find("remedy"), std::string::npos) << said;
}

TEST(Service, RefusesUnknownOptionsAsUsage) {
  Plant plant;
  Process service({"meridiand", "--no-such-option"}, plant.folder() / "usage.log");
  EXPECT_EQ(service.wait(milliseconds(3000)), 2);
}

TEST(Service, SaysWhyAVerbIsRefusedAndExecutesARepeatedRequestOnce) {
  Plant plant;
  plant.start_service();
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start);
  EXPECT_FALSE(start->is_accepted);
  EXPECT_EQ(start->refusal, Refusal::kWrongState);
  EXPECT_NE(start->text.find("enable first"), std::string::npos) << start->text;
  const auto enable = plant.say(Verb::kEnable);
  ASSERT_TRUE(enable);
  EXPECT_EQ(enable->refusal, Refusal::kNoFeedback) << enable->text;
}

}  // namespace
}  // namespace meridian::test
