// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace meridian::interpolator {
namespace {

config::RealtimeConfig gentle() {
  config::RealtimeConfig wish;
  wish.mode = config::RealtimeMode::kBestEffort;
  wish.lock_memory = false;  // a test must not lock its runner's memory
  wish.hold_dma_latency = false;
  return wish;
}

/// Runs `body` in a child without any right to real time; returns its exit code.
template <class Body>
int without_rights(Body body) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    setrlimit(RLIMIT_RTPRIO, &none);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(99);
    _exit(body());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Realtime, FailsWithTheRemedyWhereEnforcedRightsAreMissing) {
  const int code = without_rights([] {
    config::RealtimeConfig wish = gentle();
    wish.mode = config::RealtimeMode::kEnforce;
    try {
      const Realtime realtime(wish);
    } catch (const StartError& error) {
      const std::string text = error.what();
      return text.find("CAP_SYS_NICE") != std::string::npos &&
                     text.find("best_effort") != std::string::npos
                 ? 0
                 : 1;
    }
    return 2;
  });
  EXPECT_EQ(code, 0);
}

TEST(Realtime, RunsInBestEffortWithoutRightsAndSaysSo) {
  const int code = without_rights([] {
    const Realtime realtime(gentle());
    if (realtime.mode() != dds::RealtimeMode::kBestEffort) return 1;
    if (realtime.has_priorities() || realtime.remarks().empty()) return 2;
    bool has_run = false;
    {
      Thread thread(realtime, {"cycle", 80, true}, [&] { has_run = true; });
    }
    return has_run ? 0 : 3;
  });
  EXPECT_EQ(code, 0);
}

TEST(Realtime, PinsTheCycleAloneToItsCpuAndEverybodyElseOffIt) {
  cpu_set_t before;
  sched_getaffinity(0, sizeof before, &before);
  const Realtime realtime(gentle());
  cpu_set_t main_cpus, cycle_cpus, other_cpus;
  sched_getaffinity(0, sizeof main_cpus, &main_cpus);
  {
    Thread cycle(realtime, {"cycle", 0, true},
                 [&] { sched_getaffinity(0, sizeof cycle_cpus, &cycle_cpus); });
  }
  {
    Thread other(realtime, {"other", 0, false},
                 [&] { sched_getaffinity(0, sizeof other_cpus, &other_cpus); });
  }
  sched_setaffinity(0, sizeof before, &before);
  EXPECT_EQ(CPU_COUNT(&cycle_cpus), 1);
  EXPECT_TRUE(CPU_ISSET(realtime.cpu(), &cycle_cpus));
  if (CPU_COUNT(&before) > 1) {
    EXPECT_FALSE(CPU_ISSET(realtime.cpu(), &main_cpus));
    EXPECT_FALSE(CPU_ISSET(realtime.cpu(), &other_cpus));
  } else {
    EXPECT_TRUE(CPU_ISSET(realtime.cpu(), &main_cpus));
  }
}

TEST(Realtime, GivesThreadsTheirPriorityWhereItMay) {
  cpu_set_t before;
  sched_getaffinity(0, sizeof before, &before);
  const Realtime realtime(gentle());
  int policy = -1;
  sched_param param{};
  {
    Thread thread(realtime, {"planner", 40, false},
                  [&] { pthread_getschedparam(pthread_self(), &policy, &param); });
  }
  sched_setaffinity(0, sizeof before, &before);
  if (!realtime.has_priorities()) GTEST_SKIP() << "no right to FIFO priorities here";
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_EQ(param.sched_priority, 40);
}

TEST(Realtime, RefusesACpuThatIsNotThere) {
  config::RealtimeConfig wish = gentle();
  wish.cpu = CPU_SETSIZE - 1;
  EXPECT_THROW(Realtime{wish}, StartError);
}

}  // namespace
}  // namespace meridian::interpolator
