// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed_authority.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/planner/time_law.hpp"
#include "meridian/rt/stop_law.hpp"

namespace meridian {
namespace {

constexpr double kShare = 0.995;    // of the limits
constexpr double kStepDown = 0.75;  // of the ladder
constexpr int kLeastSamples = 16, kMostSamples = 96;
constexpr double kRounding_mm = 1e-9;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// The plan's state at another rate of plan time.
PathState slowed(const PathState& state, double rate) noexcept {
  return {state.s, rate * state.ds, rate * rate * state.dds, 0};
}

}  // namespace

FeedAuthority::FeedAuthority(const MachineModel& model) noexcept : count_(limited_count(model)) {
  for (int i = 0; i < count_; ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    hold_.caps.velocity[i] = fault_.caps.velocity[i] = 1 / limits.velocity;
    hold_.caps.acceleration[i] = 1 / (kShare * limits.acceleration);
    hold_.caps.jerk[i] = 1 / (kShare * limits.jerk);
    fault_.caps.acceleration[i] =
        1 / (kShare * std::max(limits.acceleration, limits.fault_acceleration));
    fault_.caps.jerk[i] = 1 / (kShare * std::max(limits.jerk, limits.fault_jerk));
  }
}

void FeedAuthority::begin(const CellGrid& grid, std::int64_t rest_cell) noexcept {
  grid_ = &grid;
  rest_cell_ = rest_cell;
}

void FeedAuthority::grant(const FeedPiece& piece, TimePiece& time) noexcept {
  const double offset = (*grid_)[piece.cell].x;
  PathState begin = state_at(time, 0), end = state_at(time, time.duration);
  begin.s -= offset;
  end.s -= offset;
  StopAuthority stop, fault;
  const double use = find(hold_, piece, begin, end, stop);
  (void)find(fault_, piece, begin, end, fault);
  time.stop_accel = use <= 1 ? stop.accel : 0;
  time.stop_jerk = use <= 1 ? stop.jerk : 0;
  time.fault_accel = fault.accel;
  time.fault_jerk = fault.jerk;
}

double FeedAuthority::find(Ladder& ladder, const FeedPiece& piece, const PathState& begin,
                           const PathState& end, StopAuthority& out) noexcept {
  const FeedCell& cell = (*grid_)[piece.cell];
  StopAuthority top{kNever, kNever};
  for (int i = 0; i < count_; ++i) {
    double rate = 1e-12;
    for (const CellSample& at : cell.at) rate = std::max(rate, std::abs(at.d1[i]));
    top.accel = std::min(top.accel, 1 / (ladder.caps.acceleration[i] * rate));
    top.jerk = std::min(top.jerk, 1 / (ladder.caps.jerk[i] * rate));
  }
  const auto rung_of = [&](const Rung& at) {
    return StopAuthority{top.accel * std::pow(kStepDown, at.accel),
                         top.jerk * std::pow(kStepDown, at.jerk)};
  };
  const PathState states[] = {begin, end, slowed(begin, 0.6), slowed(end, 0.25)};
  double least = kNever;
  Rung best = ladder.last;
  const auto passes = [&](const Rung& at) {
    if (at.accel < 0 || at.jerk < 0 || at.accel >= kAccels || at.jerk >= kJerks) return false;
    const StopAuthority authority = rung_of(at);
    double use = 0;
    for (const PathState& state : states) {
      use = std::max(use, use_of(ladder.caps, piece.cell, state, authority, least));
      if (use >= least) break;
    }
    if (use < least) {
      least = use;
      best = at;
    }
    return use <= 1;
  };
  const Rung last = ladder.last;
  if (passes(last)) {  // perhaps a sharper one does too
    const Rung sharper[] = {
        {last.accel - 1, last.jerk - 1}, {last.accel, last.jerk - 1}, {last.accel - 1, last.jerk}};
    for (const Rung& at : sharper) {
      least = kNever;
      if (passes(at)) break;
      least = 1;
      best = last;
    }
  } else {
    bool is_found = false;
    for (int sum = 0; sum <= kAccels + kJerks - 2 && !is_found; ++sum) {
      for (int a = std::max(0, sum - kJerks + 1); a <= std::min(sum, kAccels - 1) && !is_found;
           ++a) {
        is_found = passes({a, sum - a});
      }
    }
  }
  ladder.last = best;
  out = rung_of(best);
  return least;
}

double FeedAuthority::use_of(const Caps& caps, std::int64_t cell, PathState begin,
                             const StopAuthority& authority, double enough) const noexcept {
  const StopLaw law(begin, authority);
  double from = 0;  // begin of `cell`, counted from the begin of the first
  int cells = 1;
  for (double s = (*grid_)[cell].h; s < law.at(law.duration()).s; ++cells) {
    if (cell + cells >= rest_cell_) {
      if (s + kRounding_mm < law.at(law.duration()).s) return kNever;
      break;
    }
    s += (*grid_)[cell + cells].h;
  }
  const int samples = std::clamp(3 * cells, kLeastSamples, kMostSamples);
  double use = 0;
  for (int n = 0; n <= samples; ++n) {
    const PathState p = law.at(law.duration() * n / samples);
    while (p.s > from + (*grid_)[cell].h && cell + 1 < rest_cell_) from += (*grid_)[cell++].h;
    const FeedCell& here = (*grid_)[cell];
    const double place = std::clamp((p.s - from) / here.h, 0.0, 1.0) * FeedCell::kSteps;
    const auto k = static_cast<std::size_t>(std::min(place, FeedCell::kSteps - 1.0));
    for (const CellSample* at : {&here.at[k], &here.at[k + 1]}) {
      for (int i = 0; i < count_; ++i) {
        const double v = at->d1[i] * p.ds;
        const double a = at->d1[i] * p.dds + at->d2[i] * p.ds * p.ds;
        const double j =
            at->d1[i] * p.ddds + 3 * at->d2[i] * p.ds * p.dds + at->d3[i] * p.ds * p.ds * p.ds;
        use = std::max({use, std::abs(v) * caps.velocity[i], std::abs(a) * caps.acceleration[i],
                        std::abs(j) * caps.jerk[i]});
      }
    }
    if (use > enough) return use;
  }
  return use;
}

}  // namespace meridian
