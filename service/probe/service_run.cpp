// SPDX-License-Identifier: Apache-2.0
#include "service/probe/service_run.hpp"

#include <signal.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "service/probe/bare_reference.hpp"
#include "service/process/programs.hpp"

namespace meridian::probe {
namespace {

using std::chrono::milliseconds;

[[nodiscard]] std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Room for the arrivals of all turns, what comes before and between them included.
[[nodiscard]] std::size_t arrivals_of(std::int64_t period_ns, int turns) {
  constexpr std::int64_t kAround_ns = 1'000'000'000;
  return static_cast<std::size_t>((turns + 10) * (kTurn_ns + kWarmUp_ns + kAround_ns) / period_ns);
}

}  // namespace

std::map<std::uint64_t, CycleTimes> read_times(const std::filesystem::path& recording,
                                               std::int64_t period_ns) {
  std::ifstream file(recording);
  std::string line;
  std::getline(file, line);
  std::map<std::string, std::size_t> column;
  for (const std::string& name : cells_of(line)) column.emplace(name, column.size());
  std::map<std::uint64_t, CycleTimes> times;
  std::optional<std::uint64_t> before;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != column.size()) continue;  // the last row of a service that was ended
    const std::uint64_t cycle = std::stoull(cells[column.at("cycle")]);
    CycleTimes& time = times[cycle];
    const std::int64_t late_ns = std::stoll(cells[column.at("lateness_ns")]);
    time.due_ns = std::stoll(cells[column.at("due_ns")]);
    time.woke_ns = time.due_ns + late_ns;
    time.lost = before ? cycle - *before - 1 : 0;
    time.lateness_ns = late_ns + static_cast<std::int64_t>(time.lost) * period_ns;
    const std::string& state = cells[column.at("state")];
    time.is_moving = state == "running" || state == "approaching";
    if (before && time.lost == 0) {
      times[*before].computation_ns = std::stoll(cells[column.at("computation_ns")]);
    }
    before = cycle;
  }
  return times;
}

ServiceRun::ServiceRun(std::uint32_t domain, std::filesystem::path folder,
                       const std::string& machine, const std::string& name, std::int64_t period_ns,
                       int turns)
    : recording_(folder / "recording.csv"),
      period_ns_(period_ns),
      drive_side_(domain, name, arrivals_of(period_ns, turns)),
      latencies_(drive_side_.participant()),
      process_({process::program_beside("meridiand").string(), "--machine", machine, "--domain",
                std::to_string(domain), "--record", recording_.string(), "--best-effort"},
               {.error_file = (folder / "service.log").string()}) {}

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
  // Latencies are told once a second: the next ones hold all turns.
  dds::Latency latency;
  std::optional<Histogram> round_trip;
  for (int i = 0, told = 0; i < 400 && told < 2; ++i) {
    while (latencies_.take(latency)) {
      ++told;
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
  for (const Window& window : windows_) add_turn(window, times, arrivals, result);
  return result;
}

void ServiceRun::add_turn(const Window& window, const std::map<std::uint64_t, CycleTimes>& times,
                          const std::vector<DriveSide::Arrival>& arrivals, Result& result) {
  auto& lateness = result.lateness_ns.emplace_back();
  auto& one_way = result.one_way_ns.emplace_back();
  std::size_t timed = 0;
  for (const auto& [cycle, time] : times) {
    if (!window.contains(time.due_ns)) continue;
    lateness.push_back(time.lateness_ns);
    result.lost_periods += time.lost;
    timed += time.computation_ns >= 0 ? 1 : 0;
  }
  for (const DriveSide::Arrival& arrival : arrivals) {
    const auto found = times.find(arrival.cycle);
    if (found == times.end() || !window.contains(arrival.due_ns)) continue;
    const CycleTimes& time = found->second;
    if (time.computation_ns < 0) continue;
    one_way.push_back(arrival.seen_ns - (time.woke_ns + time.computation_ns));
  }
  result.sent += lateness.size();
  result.untimed += lateness.size() - timed;
  result.unseen += timed - one_way.size();
}

}  // namespace meridian::probe
