// SPDX-License-Identifier: Apache-2.0
#include "service/soak/host_watch.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace meridian::soak {
namespace {

/// Stops this process for `time` and lets it go on.
void stop_for(std::chrono::milliseconds time) {
  const pid_t me = getpid(), child = fork();
  if (child == 0) {
    kill(me, SIGSTOP);
    usleep(static_cast<useconds_t>(time.count() * 1000));
    kill(me, SIGCONT);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
}

TEST(HostWatch, SeesThatProcessorsWereAwayAndForgetsWhatIsLongAgo) {
  const sched_param top{.sched_priority = 1};
  if (sched_setscheduler(0, SCHED_FIFO, &top) != 0) GTEST_SKIP() << "no right to real time";
  const sched_param none{};
  sched_setscheduler(0, SCHED_OTHER, &none);
  const HostWatch host;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(host.is_watching());
  const auto before = host.stalls();
  stop_for(std::chrono::milliseconds(120));
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_GT(host.stalls(), before);
  EXPECT_GE(host.away_s(1), 0.1);
  EXPECT_GE(host.longest_s(), 0.1);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_LT(host.away_s(0.03), 0.1);
}

}  // namespace
}  // namespace meridian::soak
