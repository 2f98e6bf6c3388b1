// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop/stop_margin_table.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/time_law.hpp"

namespace meridian {
namespace {

constexpr double kVaried = 1.08;      // ratio of authorities that is worth cutting phases for
constexpr std::size_t kMaxLooks = 8;  // cells of a part of a phase that are looked at one by one

/// Where a stop inside `limits` ends at the farthest.
double reach_of(const PathState& p, const PathLimits& limits) noexcept {
  const double rising = std::max(p.dds, 0.0) / limits.jerk;
  const double peak = p.ds + 0.5 * rising * std::max(p.dds, 0.0);
  const double sharp = peak * limits.jerk >= limits.acceleration * limits.acceleration
                           ? peak / limits.acceleration + limits.acceleration / limits.jerk
                           : 2 * std::sqrt(peak / limits.jerk);
  return p.s + peak * (rising + sharp);
}

}  // namespace

StopMarginTable::StopMarginTable(std::span<const JointCell> cells, double offset,
                                 const JointCaps& caps, const JointCaps& fault_caps,
                                 const MotionChoice& choice) noexcept
    : cells_(cells), offset_(offset), caps_(caps), fault_caps_(fault_caps), choice_(choice) {
  double smallest = 0, largest = 0;
  for (const JointCell& cell : cells) {
    const double accel = find_acceleration({&cell, 1}, caps, 0);
    smallest = smallest == 0 ? accel : std::min(smallest, accel);
    largest = std::max(largest, accel);
  }
  is_varied_ = largest > kVaried * smallest;
}

std::span<const JointCell> StopMarginTable::cells_between(double begin, double end) const noexcept {
  std::size_t first = 0, last = cells_.size();
  while (first + 1 < last && cells_[first].end - offset_ <= begin) ++first;
  while (last > first + 1 && cells_[last - 1].begin - offset_ >= end) --last;
  return cells_.subspan(first, last - first);
}

/// Whether a stop from anywhere in `part` could use hardly more over its own reach than over that
/// of the whole part.
bool StopMarginTable::is_even(const ProfilePhase& phase, const Part& part) const noexcept {
  const auto at = [&phase](double t) {
    return PathState{phase.s + t * (phase.v + t * (phase.a / 2 + t * phase.j / 6)),
                     phase.v + t * (phase.a + t * phase.j / 2), phase.a + t * phase.j, phase.j};
  };
  const auto reach = [this](const PathState& p) { return reach_of(p, choice_.limits); };
  const PathState begin = at(part.begin);
  const auto inside = cells_between(begin.s, at(part.end).s);
  if (inside.size() > kMaxLooks) return false;
  double best = 0, farthest = 0;
  const auto looks = static_cast<int>(inside.size());
  for (int n = 0; n <= looks; ++n) {
    const PathState p = at(part.begin + (part.end - part.begin) * n / looks);
    farthest = std::max(farthest, reach(p));
    best = std::max(best, find_acceleration(cells_between(p.s, reach(p)), caps_, 0));
  }
  return best <= kVaried * find_acceleration(cells_between(begin.s, farthest), caps_, 0);
}

StopMarginTable::Cuts StopMarginTable::cut(const ProfilePhase& phase) const noexcept {
  Cuts cuts;
  if (!is_varied_) return cuts;
  const double shortest = phase.duration / 96;
  Part part{0, phase.duration};
  while (part.begin < phase.duration && cuts.count < kMaxCuts) {
    while (part.end - part.begin > shortest && !is_even(phase, part)) {
      part.end = 0.5 * (part.begin + part.end);
    }
    if (!(part.end < phase.duration)) break;
    cuts.time[cuts.count++] = part.end;
    part = {part.end, phase.duration};
  }
  return cuts;
}

void StopMarginTable::grant(TimePiece& time) const noexcept {
  const PathState begin = state_at(time, 0), end = state_at(time, time.duration);
  const PathLimits& planned = choice_.limits;
  const double profile_jerk = choice_.profile.jerk;
  // Along a phase ṡ + s̈²/2j and the place where a stop ends are largest at one of its ends.
  const auto largest = [&](auto of) { return std::max(of(begin), of(end)); };
  const auto top_of = [&](const PathState& p, double a) {
    return p.ds + 0.5 * a * a / profile_jerk;
  };
  const StopRange range{.velocity = std::min(planned.velocity, largest([&](const PathState& p) {
                                               return top_of(p, std::max(p.dds, 0.0));
                                             })),
                        .top = largest([&](const PathState& p) { return top_of(p, p.dds); }),
                        .acceleration = largest([](const PathState& p) { return std::abs(p.dds); }),
                        .fall = largest([](const PathState& p) { return std::max(-p.dds, 0.0); })};
  // A stop that may use more ends sooner: every round looks at less of the path.
  PathLimits stop = planned;
  auto cells = cells_;
  for (int n = 0; n < (is_varied_ ? 3 : 1); ++n) {
    const double reach = largest([&](const PathState& p) { return reach_of(p, stop); });
    if (is_varied_) cells = cells_between(begin.s, reach);
    stop = find_authority(cells, caps_, range);
    stop.acceleration = std::max(stop.acceleration, choice_.profile.peak_acceleration());
    stop.jerk = std::max(stop.jerk, profile_jerk);
  }
  time.stop_accel = stop.acceleration;
  time.stop_jerk = stop.jerk;
  const PathLimits fault = find_authority(cells, fault_caps_, range);
  time.fault_accel = std::max(fault.acceleration, time.stop_accel);
  time.fault_jerk = std::max(fault.jerk, time.stop_jerk);
  time.authority_velocity = range.velocity;
  time.rest_stop_accel = find_acceleration(cells, caps_, 0);
  time.rest_stop_jerk = find_jerk(cells, caps_, 0, 0);
  time.rest_fault_accel = find_acceleration(cells, fault_caps_, 0);
  time.rest_fault_jerk = find_jerk(cells, fault_caps_, 0, 0);
}

}  // namespace meridian
