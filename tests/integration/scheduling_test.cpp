// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "integration/plant.hpp"

namespace meridian::test {
namespace {

namespace fs = std::filesystem;

/// The threads of a process by their names, "main" for the first, with what the kernel schedules
/// them as.
[[nodiscard]] std::multimap<std::string, int> policies_of(pid_t process) {
  std::multimap<std::string, int> policies;
  std::error_code gone;
  for (fs::directory_iterator at("/proc/" + std::to_string(process) + "/task", gone), end;
       !gone && at != end; at.increment(gone)) {
    const pid_t thread = std::stoi(at->path().filename());
    std::string name;
    std::getline(std::ifstream(at->path() / "comm"), name);
    policies.emplace(thread == process ? "main" : name, ::sched_getscheduler(thread));
  }
  return policies;
}

/// Names of the threads that are not of real-time class.
[[nodiscard]] std::set<std::string> normal_ones(pid_t process) {
  std::set<std::string> names;
  for (const auto& [name, policy] : policies_of(process)) {
    if (policy != SCHED_FIFO && policy != -1) names.insert(name);
  }
  return names;
}

[[nodiscard]] bool has_right_to_real_time() {
  const sched_param top{.sched_priority = 80}, none{};
  return ::sched_setscheduler(0, SCHED_FIFO, &top) == 0 &&
         ::sched_setscheduler(0, SCHED_OTHER, &none) == 0;
}

/// A thread of normal class that a busy processor keeps from running keeps what it has locked: the
/// receive thread, and with it the feedback, would wait for it.
class Scheduling : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_right_to_real_time()) GTEST_SKIP() << "no right to FIFO priorities here";
  }
  Plant plant_;
};

TEST_F(Scheduling, LetsOnlyThreadsThatNeverUseDdsRunAtNormalClassInTheService) {
  Process& service = plant_.start_service({"--trace", (plant_.folder() / "traces").string()});
  ASSERT_EQ(plant_.status().state, State::kOff) << service.said();
  // The log's thread is called as the program.
  const std::set<std::string> no_dds{"audit",  "flight", "journal",
                                     "recorder", "tracer", "meridiand"};
  EXPECT_TRUE(eventually([&] { return normal_ones(service.pid()) == no_dds; }))
      << testing::PrintToString(normal_ones(service.pid()));
  const auto all = policies_of(service.pid());
  for (const char* name : {"main", "recv", "dq.builtins", "gc", "intake", "telemetry", "cycle",
                           "replies", "drives"}) {
    EXPECT_TRUE(all.contains(name)) << name;
  }
}

TEST_F(Scheduling, LetsOnlyWhatPrintsRunAtNormalClassInTheDrives) {
  Process& drives = plant_.start_drives();
  const std::set<std::string> printing{"meridian"};
  EXPECT_TRUE(eventually([&] { return normal_ones(drives.pid()) == printing; }))
      << testing::PrintToString(normal_ones(drives.pid()));
  EXPECT_TRUE(policies_of(drives.pid()).contains("dq.builtins"));
}

}  // namespace
}  // namespace meridian::test
