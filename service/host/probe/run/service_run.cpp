// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/service_run.hpp"

#include <signal.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "service/host/probe/run/bare_reference.hpp"

namespace meridian::probe {
namespace {

using std::chrono::milliseconds;

/// Room for the arrivals of all turns, what comes before and between them included.
[[nodiscard]] std::size_t arrivals_of(std::int64_t period_ns, int turns) {
  constexpr std::int64_t kAround_ns = 1'000'000'000;
  return static_cast<std::size_t>((turns + 10) * (kTurn_ns + kWarmUp_ns + kAround_ns) / period_ns);
}

}  // namespace

ServiceRun::ServiceRun(const ServiceSetup& setup, int turns)
    : recording_(setup.folder / "recording.csv"),
      period_ns_(setup.period_ns),
      drive_side_(setup.domain, setup.name, arrivals_of(setup.period_ns, turns)),
      latencies_(drive_side_.participant()),
      process_(setup.command(recording_),
               {.error_file = (setup.folder / "service.log").string(), .has_own_group = true}) {}

bool ServiceRun::is_up() const {
  for (int i = 0; i < 1000 && drive_side_.count() < 100; ++i) {
    std::this_thread::sleep_for(milliseconds(10));
  }
  return drive_side_.count() >= 100;
}

void ServiceRun::take_turn() {
  process_.send_signal(SIGCONT);
  // Stopped for longer than its lease it was forgotten: the turn begins when it is seen again.
  const std::size_t before = drive_side_.count();
  for (int i = 0; i < 5000 && drive_side_.count() < before + 10; ++i) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  drive_side_.answer(true);
  const std::int64_t begin_ns = monotonic_ns() + kWarmUp_ns;
  windows_.push_back({begin_ns, begin_ns + kTurn_ns});
  std::this_thread::sleep_for(std::chrono::nanoseconds(kWarmUp_ns + kTurn_ns));
  pause();
}

void ServiceRun::pause() {
  drive_side_.answer(false);
  std::this_thread::sleep_for(milliseconds(20));  // what is on its way arrives
  process_.send_signal(SIGSTOP);
}

ServiceRun::Result ServiceRun::end() {
  process_.send_signal(SIGCONT);
  // Latencies are published once a second: the next ones hold all turns.
  dds::Latency latency;
  std::optional<Histogram> round_trip;
  for (int i = 0, published = 0; i < 400 && published < 2; ++i) {
    while (latencies_.take(latency)) {
      ++published;
      for (const dds::NamedHistogram& one : latency.histograms) {
        if (one.name == "setpoint to feedback") round_trip = one.histogram;
      }
    }
    std::this_thread::sleep_for(milliseconds(10));
  }
  process_.send_signal(SIGTERM);
  if (process_.wait_for_exit(milliseconds(12'000)) != 0) {
    throw std::runtime_error("meridiand does not end as it should");
  }
  Result result;
  result.round_trip = round_trip;
  const auto times = read_times(recording_, period_ns_);
  const auto arrivals = drive_side_.arrivals();
  for (const Window& window : windows_) {
    add_turn(window, period_ns_, times, arrivals, result.turns);
  }
  return result;
}

}  // namespace meridian::probe
