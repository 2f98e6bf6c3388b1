// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/watch/host_watch.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

#include "service/host/process/processors.hpp"
#include "service/protocol/steady_ns.hpp"

namespace meridian::soak {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// `length_ms` long, until `end_ms`, on processor `cpu`.
[[nodiscard]] Stall stall(std::int64_t end_ms, std::int64_t length_ms, int cpu = 0) {
  return {end_ms * kMs, length_ms * kMs, cpu};
}

TEST(LongestAway, AddsStallsThatFollowOneAnotherAtOnce) {
  const std::vector<Stall> chained{stall(120, 20), stall(145, 20), stall(170, 15)};
  EXPECT_EQ(longest_away_ns(chained, 0, kNever), 55 * kMs);
}

TEST(LongestAway, MakesNoLongStallOfStallsApart) {
  std::vector<Stall> apart;
  for (int i = 1; i <= 10; ++i) apart.push_back(stall(100 * i, 15 + i));
  EXPECT_EQ(longest_away_ns(apart, 0, kNever), 25 * kMs);
  EXPECT_EQ(longest_away_ns(std::vector{stall(120, 20), stall(151, 20)}, 0, kNever), 20 * kMs)
      << "between them the processor was there for 11 ms, more than two naps";
}

TEST(LongestAway, AddsNothingOfOneProcessorToAnother) {
  const std::vector<Stall> both{stall(120, 20, 0), stall(121, 20, 1), stall(142, 20, 0),
                                stall(146, 25, 1)};
  EXPECT_EQ(longest_away_ns(both, 0, kNever), 45 * kMs);
}

TEST(LongestAway, IsOfTheTimeThatWasAskedForAlone) {
  const std::vector<Stall> stalls{stall(100, 90), stall(500, 30), stall(900, 60)};
  EXPECT_EQ(longest_away_ns(stalls, 101 * kMs, 840 * kMs), 30 * kMs);
  EXPECT_EQ(longest_away_ns(stalls, 101 * kMs, 880 * kMs), 40 * kMs) << "what is behind is cut off";
  EXPECT_EQ(longest_away_ns({}, 0, kNever), 0);
}

TEST(HostWatch, NapsShorterWhereDrivesBridgeLess) {
  EXPECT_EQ(HostWatch::nap_ns(50 * kMs), 5 * kMs);
  EXPECT_EQ(HostWatch::nap_ns(3 * kMs), kMs);
}

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

TEST(HostWatch, SeesThatProcessorsWereAwayAndReportsWhen) {
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
  const std::int64_t now_ns = stream::steady_ns(), second_ago_ns = now_ns - 1000 * kMs;
  EXPECT_GE(longest_away_ns(host.stalls_since(second_ago_ns), second_ago_ns, now_ns), 100 * kMs);
  EXPECT_GE(host.longest_s(), 0.1);
  EXPECT_GE(host.lateness(process::last_cpu()).max_ns(), 100 * kMs);
  EXPECT_GT(host.lateness(process::last_cpu()).count(), 5U) << "every nap counts, late or not";
  EXPECT_EQ(host.lateness(CPU_SETSIZE).count(), 0U);
  for (const Stall& one : host.stalls_since(now_ns)) EXPECT_GE(one.end_ns, now_ns);
}

/// As the unit and limits.d leave it: the service's user may have FIFO 98 and no more.
TEST(HostWatch, WatchesWithinTheLimitOfAUser) {
  constexpr int kNoRights = 77, kNobody = 65534;
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{98, 98};
    const sched_param high{.sched_priority = 98}, none{};
    if (setrlimit(RLIMIT_RTPRIO, &limit) != 0 || setuid(kNobody) != 0 ||
        sched_setscheduler(0, SCHED_FIFO, &high) != 0) {
      _exit(kNoRights);
    }
    sched_setscheduler(0, SCHED_OTHER, &none);
    const HostWatch host;
    for (int i = 0; i < 100 && !host.is_watching(); ++i) usleep(10'000);
    _exit(host.is_watching() ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  if (WEXITSTATUS(status) == kNoRights) GTEST_SKIP() << "no right to give rights away";
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace meridian::soak
