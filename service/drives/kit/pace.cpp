// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/pace.hpp"

#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <thread>

namespace meridian::drive {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

void sleep_until(std::int64_t due_ns) noexcept {
  const timespec due{due_ns / kSecond_ns, due_ns % kSecond_ns};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) != 0) {
  }
}

}  // namespace

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

RaisedPriority::RaisedPriority(int priority) noexcept {
  if (priority <= 0) return;
  sched_param before{};
  ::pthread_getschedparam(::pthread_self(), &policy_before_, &before);
  priority_before_ = before.sched_priority;
  const sched_param raised{.sched_priority = priority};
  is_raised_ = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &raised) == 0;
}

RaisedPriority::~RaisedPriority() {
  const sched_param before{.sched_priority = priority_before_};
  if (is_raised_) ::pthread_setschedparam(::pthread_self(), policy_before_, &before);
}

bool may_have_priority(int priority) {
  bool may = false;
  std::thread([&] { may = RaisedPriority(priority).is_raised(); }).join();
  return may;
}

Pace::Pace(std::int64_t period_ns) noexcept
    : period_ns_(period_ns), due_ns_(monotonic_ns()), now_ns_(due_ns_) {}

int Pace::sleep() noexcept {
  due_ns_ += period_ns_;
  sleep_until(due_ns_);
  now_ns_ = monotonic_ns();
  const std::int64_t lost = (now_ns_ - due_ns_) / period_ns_;
  due_ns_ += lost * period_ns_;
  return static_cast<int>(lost);
}

void keep_off_last_processor() noexcept {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  if (::sched_getaffinity(0, sizeof cpus, &cpus) != 0 || CPU_COUNT(&cpus) < 2) return;
  int last = 0;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) last = CPU_ISSET(cpu, &cpus) ? cpu : last;
  CPU_CLR(last, &cpus);
  static_cast<void>(::sched_setaffinity(0, sizeof cpus, &cpus));
}

}  // namespace meridian::drive
