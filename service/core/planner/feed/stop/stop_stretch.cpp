// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop/stop_stretch.hpp"

#include <algorithm>

namespace meridian {
namespace {

PathState slowed(const PathState& p, double rate) noexcept {
  return {p.s, rate * p.ds, rate * rate * p.dds, 0};
}

}  // namespace

StopStretch::StopStretch(const CellGrid& grid, std::span<const FeedPiece> pieces,
                         std::span<const TimePiece> times) noexcept
    : count_(std::min(kMaxParts, pieces.size())) {
  std::int64_t cell = pieces[0].cell;
  double cell_begin = 0;
  for (std::size_t n = 0; n < count_; ++n) {
    for (; cell < pieces[n].cell; ++cell) cell_begin += grid[cell].h;
    const TimePiece& time = times[n];
    const double shift = cell_begin - grid[cell].x;
    const auto state = [&](double share) {
      PathState at = state_at(time, share * time.duration);
      at.s += shift;
      return at;
    };
    parts_[n] = {cell, cell_begin, time.duration, state(0), {state(0.25), state(0.5), state(0.75)}};
    if (n + 1 == count_) end_ = state(1);
  }
}

StopStretch StopStretch::at_rate(double rate) const noexcept {
  StopStretch out = *this;
  for (std::size_t n = 0; n < count_; ++n) {
    Part& part = out.parts_[n];
    part.duration /= rate;
    part.begin = slowed(part.begin, rate);
    for (PathState& at : part.between) at = slowed(at, rate);
  }
  out.end_ = slowed(end_, rate);
  out.rate_ = rate * rate_;
  return out;
}

double StopStretch::min_velocity() const noexcept {
  double min = end_.ds;
  for (const Part& part : parts()) min = std::min(min, part.begin.ds);
  return min;
}

double StopStretch::max_deceleration() const noexcept {
  double max = std::max(0.0, -end_.dds);
  for (const Part& part : parts()) max = std::max(max, -part.begin.dds);
  return max;
}

}  // namespace meridian
