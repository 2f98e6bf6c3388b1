// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/turn_figures.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

namespace meridian::probe {
namespace {

[[nodiscard]] std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Whether the drives saw this setpoint, and when: the first arrival of its cycle.
[[nodiscard]] const DriveSide::Arrival* find_arrival(
    const std::vector<DriveSide::Arrival>& arrivals, std::uint64_t cycle) {
  const auto at = std::lower_bound(
      arrivals.begin(), arrivals.end(), cycle,
      [](const DriveSide::Arrival& one, std::uint64_t c) { return one.cycle < c; });
  return at != arrivals.end() && at->cycle == cycle ? &*at : nullptr;
}

}  // namespace

std::vector<CycleTimes> read_times(const std::filesystem::path& recording, std::int64_t period_ns) {
  std::ifstream file(recording);
  std::string line;
  std::getline(file, line);
  std::map<std::string, std::size_t> column;
  for (const std::string& name : cells_of(line)) column.emplace(name, column.size());
  std::vector<CycleTimes> times;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != column.size()) continue;  // the last row of a service that was ended
    CycleTimes time;
    time.cycle = std::stoull(cells[column.at("cycle")]);
    const std::int64_t late_ns = std::stoll(cells[column.at("lateness_ns")]);
    time.due_ns = std::stoll(cells[column.at("due_ns")]);
    time.woke_ns = time.due_ns + late_ns;
    time.lateness_ns = late_ns;
    const std::string& state = cells[column.at("state")];
    time.is_moving = state == "running" || state == "approaching";
    if (!times.empty()) {
      // A computation longer than its period is reported like any other, after the periods it cost.
      times.back().computation_ns = std::stoll(cells[column.at("computation_ns")]);
      time.lost = time.cycle - times.back().cycle - 1;
      time.lateness_ns += static_cast<std::int64_t>(time.lost) * period_ns;
    }
    times.push_back(time);
  }
  return times;
}

void add_turn(const Window& window, std::int64_t period_ns, const std::vector<CycleTimes>& times,
              const std::vector<DriveSide::Arrival>& arrivals, TurnFigures& figures) {
  const auto is_before = [](const CycleTimes& time, std::int64_t at_ns) {
    return time.due_ns < at_ns;
  };
  const auto begin = std::lower_bound(times.begin(), times.end(), window.begin_ns, is_before);
  const auto end = std::lower_bound(begin, times.end(), window.end_ns, is_before);
  auto& late_ns = figures.lateness_ns.emplace_back();
  auto& one_way = figures.one_way_ns.emplace_back();
  std::uint64_t timed = 0;
  for (auto at = begin; at != end; ++at) {
    late_ns.push_back(at->lateness_ns);
    figures.moving += at->is_moving ? 1 : 0;
    if (at->computation_ns < 0) {
      ++figures.untimed;
      continue;
    }
    ++timed;
    if (at->is_moving) figures.computation_ns.push_back(at->computation_ns);
    if (const auto* const arrival = find_arrival(arrivals, at->cycle)) {
      one_way.push_back(arrival->seen_ns - (at->woke_ns + at->computation_ns));
    }
  }
  const auto periods = static_cast<std::uint64_t>((window.end_ns - window.begin_ns) / period_ns);
  const auto executed = static_cast<std::uint64_t>(std::distance(begin, end));
  figures.periods += {periods - std::min(periods, executed), periods};
  figures.setpoints += {timed - std::min<std::uint64_t>(timed, one_way.size()), timed};
}

std::vector<Window> moving_turns(const std::vector<CycleTimes>& times, std::int64_t period_ns,
                                 std::int64_t turn_ns) {
  const auto is_moving = [](const CycleTimes& time) { return time.is_moving; };
  const auto first = std::find_if(times.begin(), times.end(), is_moving);
  if (first == times.end()) return {};
  const auto last = std::find_if(times.rbegin(), times.rend(), is_moving);
  std::vector<Window> turns;
  std::int64_t begin_ns = first->due_ns;
  const std::int64_t end_ns = last->due_ns + period_ns;
  for (; end_ns - begin_ns >= 2 * turn_ns; begin_ns += turn_ns) {
    turns.push_back({begin_ns, begin_ns + turn_ns});
  }
  turns.push_back({begin_ns, end_ns});
  return turns;
}

}  // namespace meridian::probe
