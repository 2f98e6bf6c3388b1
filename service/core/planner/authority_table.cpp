// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/authority_table.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/time_law.hpp"

namespace meridian {
namespace {

constexpr double kVaried = 1.12;  // ratio of authorities that is worth cutting phases for

/// Farthest that a stop inside `limits` gets from ṡ = v, s̈ = a.
double stopping_distance(double v, double a, const PathLimits& limits) noexcept {
  const double rising = std::max(a, 0.0) / limits.jerk;
  const double peak = v + 0.5 * rising * std::max(a, 0.0);
  const double sharp = peak * limits.jerk >= limits.acceleration * limits.acceleration
                           ? peak / limits.acceleration + limits.acceleration / limits.jerk
                           : 2 * std::sqrt(peak / limits.jerk);
  return peak * (rising + sharp);
}

}  // namespace

AuthorityTable::AuthorityTable(std::span<const JointCell> cells, double offset,
                               const JointCaps& caps, const JointCaps& fault_caps,
                               const MotionChoice& choice) noexcept
    : cells_(cells), offset_(offset), caps_(caps), fault_caps_(fault_caps), choice_(choice) {
  double least = 0, most = 0;
  for (const JointCell& cell : cells) {
    const double accel = find_acceleration({&cell, 1}, caps, 0);
    least = least == 0 ? accel : std::min(least, accel);
    most = std::max(most, accel);
  }
  is_varied_ = most > kVaried * least;
}

std::span<const JointCell> AuthorityTable::cells_between(double begin, double end) const noexcept {
  std::size_t first = 0, last = cells_.size();
  while (first + 1 < last && cells_[first].end - offset_ <= begin) ++first;
  while (last > first + 1 && cells_[last - 1].begin - offset_ >= end) --last;
  return cells_.subspan(first, last - first);
}

AuthorityTable::Cuts AuthorityTable::cut(const ProfilePhase& phase) const noexcept {
  Cuts cuts;
  if (!is_varied_) return cuts;
  const auto s_at = [&phase](double t) {
    return phase.s + t * (phase.v + t * (phase.a / 2 + t * phase.j / 6));
  };
  const auto cells = cells_between(phase.s, s_at(phase.duration));
  double least = find_acceleration(cells.first(1), caps_, 0), most = least;
  for (std::size_t n = 1; n < cells.size() && cuts.count < kMostCuts; ++n) {
    const double accel = find_acceleration(cells.subspan(n, 1), caps_, 0);
    least = std::min(least, accel);
    most = std::max(most, accel);
    if (most < kVaried * least) continue;
    // The cut is made where this cell begins.
    double low = cuts.count > 0 ? cuts.time[cuts.count - 1] : 0, high = phase.duration;
    const double where = cells[n].begin - offset_;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (s_at(middle) < where ? low : high) = middle;
    }
    if (low > 0 && low < phase.duration) cuts.time[cuts.count++] = low;
    least = most = accel;
  }
  return cuts;
}

void AuthorityTable::grant(TimePiece& time) const noexcept {
  const PathState end = state_at(time, time.duration);
  const PathLimits& planned = choice_.limits;
  const double accel = std::max(std::abs(time.a), std::abs(end.dds));
  const double rise = std::max({time.a, end.dds, 0.0});
  const double velocity = std::min(
      planned.velocity, std::max(time.v, end.ds) + 0.5 * rise * rise / choice_.profile.jerk);
  const double from = std::max(end.s, time.s0);
  // A stop that may use more ends sooner: every round looks at less of the path.
  PathLimits stop = planned;
  auto cells = cells_;
  for (int n = 0; n < (is_varied_ ? 3 : 1); ++n) {
    if (is_varied_) cells = cells_between(time.s0, from + stopping_distance(velocity, rise, stop));
    stop = find_authority(cells, caps_, velocity, accel);
    stop.acceleration = std::max(stop.acceleration, choice_.profile.peak_acceleration());
    stop.jerk = std::max(stop.jerk, choice_.profile.jerk);
  }
  time.stop_accel = stop.acceleration;
  time.stop_jerk = stop.jerk;
  const PathLimits fault = find_authority(cells, fault_caps_, velocity, accel);
  time.fault_accel = std::max(fault.acceleration, time.stop_accel);
  time.fault_jerk = std::max(fault.jerk, time.stop_jerk);
  time.authority_velocity = velocity;
  time.slow_stop_accel = find_acceleration(cells, caps_, 0);
  time.slow_stop_jerk = find_jerk(cells, caps_, 0, 0);
  time.slow_fault_accel = find_acceleration(cells, fault_caps_, 0);
  time.slow_fault_jerk = find_jerk(cells, fault_caps_, 0, 0);
}

}  // namespace meridian
