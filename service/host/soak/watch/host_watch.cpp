// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/watch/host_watch.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>

#include "service/host/process/processors.hpp"
#include "service/protocol/steady_ns.hpp"

namespace meridian::soak {
namespace {

/// A processor that comes back for no longer than this does no more than begin to catch up.
constexpr std::int64_t kOneStall_ns = 10'000'000;

/// Above every thread of the service; of a user without CAP_SYS_NICE as high as its limit allows.
[[nodiscard]] bool rise() noexcept {
  const int top = sched_get_priority_max(SCHED_FIFO);
  const auto take = [](int priority) {
    const sched_param wish{.sched_priority = priority};
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &wish) == 0;
  };
  if (take(top)) return true;
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) != 0 || limit.rlim_cur == 0) return false;
  return take(static_cast<int>(std::min<rlim_t>(limit.rlim_cur, static_cast<rlim_t>(top))));
}

[[nodiscard]] bool rise_on(int cpu) noexcept {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(cpu, &one);
  return pthread_setaffinity_np(pthread_self(), sizeof(one), &one) == 0 && rise();
}

}  // namespace

std::int64_t longest_away_ns(std::span<const Stall> stalls, std::int64_t since_ns,
                             std::int64_t until_ns) {
  struct Away {
    std::int64_t end_ns = 0, length_ns = 0;
  };
  std::map<int, Away> away;  // the newest of each processor
  std::int64_t longest_ns = 0;
  for (const Stall& stall : stalls) {
    const std::int64_t begin_ns = stall.end_ns - stall.length_ns;
    if (stall.end_ns < since_ns || begin_ns >= until_ns) continue;
    Away& here = away[stall.cpu];
    const bool goes_on = here.length_ns > 0 && begin_ns - here.end_ns <= kOneStall_ns;
    const std::int64_t end_ns = std::min(stall.end_ns, until_ns);
    here = {end_ns, end_ns - begin_ns + (goes_on ? here.length_ns : 0)};
    longest_ns = std::max(longest_ns, here.length_ns);
  }
  return longest_ns;
}

HostWatch::HostWatch(std::int64_t bridge_ns)
    : nap_ns_(nap_ns(bridge_ns)),
      min_ns_(std::clamp(bridge_ns - nap_ns_, nap_ns_, std::int64_t{kStall_ns})) {
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &process::initial_cpus())) continue;
    threads_.emplace_back([this, cpu](const std::stop_token& stop) { watch(cpu, stop); });
  }
}

HostWatch::~HostWatch() = default;

void HostWatch::watch(int cpu, const std::stop_token& stop) {
  if (!rise_on(cpu)) return;
  ++watched_;
  while (!stop.stop_requested()) {
    const std::int64_t due_ns = stream::steady_ns() + nap_ns_;
    std::this_thread::sleep_for(std::chrono::nanoseconds(nap_ns_));
    const std::int64_t now_ns = stream::steady_ns();
    note({now_ns, now_ns - due_ns, cpu});
  }
}

void HostWatch::note(const Stall& late) {
  const std::lock_guard lock(mutex_);
  lateness_[late.cpu].record(late.length_ns);
  if (late.length_ns >= kStall_ns) {
    ++count_;
    longest_ns_ = std::max(longest_ns_, late.length_ns);
  }
  if (late.length_ns < min_ns_) return;
  if (stalls_.size() == kMaxStalls) stalls_.erase(stalls_.begin());
  stalls_.push_back(late);
}

Histogram HostWatch::lateness(int cpu) const {
  const std::lock_guard lock(mutex_);
  const auto at = lateness_.find(cpu);
  return at == lateness_.end() ? Histogram{} : at->second;
}

std::vector<Stall> HostWatch::stalls_since(std::int64_t since_ns) const {
  std::vector<Stall> out;
  const std::lock_guard lock(mutex_);
  std::ranges::copy_if(stalls_, std::back_inserter(out),
                       [since_ns](const Stall& stall) { return stall.end_ns >= since_ns; });
  return out;
}

std::uint64_t HostWatch::stalls() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

double HostWatch::longest_s() const {
  const std::lock_guard lock(mutex_);
  return static_cast<double>(longest_ns_) * 1e-9;
}

}  // namespace meridian::soak
