// SPDX-License-Identifier: Apache-2.0
#include "latency/drive_side.hpp"

#include <sched.h>

#include <ctime>

#include "latency/figures.hpp"

namespace meridian::latency {
namespace {

constexpr std::size_t kMostArrivals = 200'000;

}  // namespace

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

void stay_off_cpu(int cpu) {
  cpu_set_t set;
  sched_getaffinity(0, sizeof set, &set);
  if (CPU_COUNT(&set) > 1) {
    CPU_CLR(cpu, &set);
    sched_setaffinity(0, sizeof set, &set);
  }
}

int last_cpu() {
  cpu_set_t set;
  sched_getaffinity(0, sizeof set, &set);
  int last = 0;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &set)) {
      last = i;
    }
  }
  return last;
}

DriveSide::DriveSide(std::uint32_t domain, const std::string& partition)
    : arrivals_(kMostArrivals),
      participant_({.domain = domain,
                    .machine = partition,
                    .transport = has_realtime_rights() ? dds::Transport::kLoopbackRealtime
                                                       : dds::Transport::kLoopback}),
      reader_(participant_, [this](dds::Reader<dds::SetpointSample>& reader) { note(reader); }) {}

void DriveSide::note(dds::Reader<dds::SetpointSample>& reader) {
  dds::SetpointSample sample;
  while (reader.take(sample)) {
    const std::size_t index = count_.load(std::memory_order_relaxed);
    if (index < arrivals_.size()) {
      arrivals_[index] = {sample.setpoint.cycle, sample.setpoint.due_ns, monotonic_ns()};
      count_.store(index + 1, std::memory_order_release);
    }
  }
}

std::vector<DriveSide::Arrival> DriveSide::arrivals() const {
  const auto count = static_cast<std::ptrdiff_t>(count_.load(std::memory_order_acquire));
  return {arrivals_.begin(), arrivals_.begin() + count};
}

}  // namespace meridian::latency
