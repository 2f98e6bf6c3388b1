// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/service_setup.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "service/host/process/processors.hpp"
#include "service/host/process/programs.hpp"

namespace meridian::probe {
namespace {

TEST(ServiceSetup, MeasuresTheRealTimeOfTheServiceThatWillServe) {
  const process::ScratchFolder folder;
  ServiceSetup setup{.domain = 7,
                     .folder = folder.path(),
                     .machine = process::shipped_file("machines/lai.toml").string(),
                     .name = "lai",
                     .period_ns = 1'000'000};
  setup.realtime.cpu = 3;
  setup.realtime.cycle_priority = 85;
  setup.realtime.io_priority = 51;
  setup.realtime.lock_memory = false;
  const auto words = setup.command(folder.path() / "recording.csv");
  const auto named = std::find(words.begin(), words.end(), "--service");
  ASSERT_NE(named, words.end());
  const config::ServiceConfig service = config::load_service(*(named + 1));
  EXPECT_EQ(service.realtime.cpu, 3);
  EXPECT_EQ(service.realtime.cycle_priority, 85);
  EXPECT_EQ(service.realtime.publisher_priority, setup.realtime.publisher_priority);
  EXPECT_EQ(service.realtime.io_priority, 51);
  EXPECT_EQ(service.realtime.mode, config::RealtimeMode::kBestEffort);
  EXPECT_FALSE(service.realtime.lock_memory);
  EXPECT_TRUE(service.realtime.hold_dma_latency);
  EXPECT_EQ(service.machine, setup.machine);
  EXPECT_TRUE(service.state_directory.empty() && service.log.empty() && service.recording.empty())
      << "a service that serves meanwhile keeps its own";
}

TEST(ServiceSetup, ProcessorsThatWeHaveAreTakenAndOthersRefused) {
  EXPECT_TRUE(process::take_cpu(process::last_cpu()));
  EXPECT_FALSE(process::take_cpu(CPU_SETSIZE - 1)) << "a host of 1024 processors";
  EXPECT_FALSE(process::take_cpu(-1));
  EXPECT_FALSE(CPU_ISSET(CPU_SETSIZE - 1, &process::initial_cpus()));
}

void expect_taken(int wanted) {
  ASSERT_FALSE(CPU_ISSET(wanted, &process::initial_cpus()));
  ASSERT_TRUE(process::take_cpu(wanted));
  EXPECT_EQ(process::last_cpu(), wanted);
}

/// As a shell on a host with isolated processors: its set has not all that there are. What a
/// process was given is known as it starts, so the test runs itself once more.
TEST(ServiceSetup, AProcessorThatWasKeptFromUsIsTakenForWhatWeStart) {
  if (const char* const kept = std::getenv("MERIDIAN_TEST_CPU")) {
    return expect_taken(std::atoi(kept));
  }
  const cpu_set_t before = process::initial_cpus();
  if (CPU_COUNT(&before) < 2) GTEST_SKIP() << "one processor only";
  const int last = process::last_cpu();
  EXPECT_EXIT(
      {
        cpu_set_t narrow = before;
        CPU_CLR(last, &narrow);
        sched_setaffinity(0, sizeof narrow, &narrow);
        setenv("MERIDIAN_TEST_CPU", std::to_string(last).c_str(), 1);
        execl("/proc/self/exe", "probe_test", "--gtest_filter=ServiceSetup.AProcessorThatWasKept*",
              nullptr);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace meridian::probe
