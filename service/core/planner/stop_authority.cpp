// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/stop_authority.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/time_law.hpp"

namespace meridian {
namespace {

constexpr double kVaried = 1.05;  // ratio of authorities that is worth cutting phases for
constexpr int kMostParts = 8;

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

StopAuthority::StopAuthority(std::span<const JointCell> cells, double offset, const JointCaps& caps,
                             const JointCaps& fault_caps, const MotionChoice& choice) noexcept
    : cells_(cells), offset_(offset), caps_(caps), fault_caps_(fault_caps), choice_(choice) {
  double least = 0, most = 0;
  for (const JointCell& cell : cells) {
    const double accel = find_acceleration({&cell, 1}, caps, 0);
    least = least == 0 ? accel : std::min(least, accel);
    most = std::max(most, accel);
  }
  is_varied_ = most > kVaried * least;
}

std::span<const JointCell> StopAuthority::cells_between(double begin, double end) const noexcept {
  std::size_t first = 0, last = cells_.size();
  while (first + 1 < last && cells_[first].end - offset_ <= begin) ++first;
  while (last > first + 1 && cells_[last - 1].begin - offset_ >= end) --last;
  return cells_.subspan(first, last - first);
}

int StopAuthority::parts_of(const ProfilePhase& phase) const noexcept {
  if (!is_varied_) return 1;
  const double t = phase.duration;
  const double end = phase.s + t * (phase.v + t * (phase.a / 2 + t * phase.j / 6));
  const auto touched = static_cast<int>(cells_between(phase.s, end).size());
  return std::clamp(touched, 1, kMostParts);
}

void StopAuthority::grant(TimePiece& time) const noexcept {
  const PathState end = state_at(time, time.duration);
  const PathLimits& planned = choice_.limits;
  const double accel = std::max(std::abs(time.a), std::abs(end.dds));
  const double rise = std::max({time.a, end.dds, 0.0});
  const double velocity = std::min(
      planned.velocity, std::max(time.v, end.ds) + 0.5 * rise * rise / choice_.profile.jerk);
  const double reach = std::max(end.s, time.s0) + stopping_distance(velocity, rise, planned);
  const auto cells = is_varied_ ? cells_between(time.s0, reach) : cells_;
  const PathLimits stop = find_authority(cells, caps_, velocity, accel);
  time.stop_accel = std::max(stop.acceleration, choice_.profile.peak_acceleration());
  time.stop_jerk = std::max(stop.jerk, choice_.profile.jerk);
  const PathLimits fault = find_authority(cells, fault_caps_, velocity, accel);
  time.fault_accel = std::max(fault.acceleration, time.stop_accel);
  time.fault_jerk = std::max(fault.jerk, time.stop_jerk);
}

}  // namespace meridian
