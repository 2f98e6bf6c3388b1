// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop/feed_stop_margin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "meridian/planner/time_law.hpp"

namespace meridian {
namespace {

constexpr double kShare = 0.99;      // of the limits
constexpr double kMaxGrowth = 1.25;  // of the authority from piece to piece, at most
constexpr double kLess = 0.98;       // of what would just do
constexpr int kMarginRounds = 8;     // of lessening
constexpr double kHopeless = 0.02;   // of what the piece's own cell allows
constexpr double kEasing = 0.9;      // of the deceleration that there is: a stop may ease off to it
constexpr double kRounding_mm = 1e-9;
constexpr double kTiny = 1e-12;
constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();
constexpr double kFast = 1.0002;  // on ṡ² that feed and velocity allow: what a plan may use
constexpr double kSlow = 0.4;     // rate of plan time below which slow_* may be used
/// Rates of plan time at which authority is sought where there is none at the full rate.
constexpr double kRates[] = {0.97, 0.94, 0.9, 0.85, 0.78, 0.7, 0.6, 0.45, 0.3, 0.15};
/// The same of a tail, which is hardly ever run.
constexpr double kTailRates[] = {0.85, 0.6};

/// Deepest deceleration of a stop that nothing but its jerk bounds.
double depth_of(const PathState& p, double jerk) noexcept {
  return std::sqrt(jerk * p.ds + 0.5 * p.dds * p.dds);
}

}  // namespace

FeedStopMargin::FeedStopMargin(const MachineModel& model) noexcept
    : FeedStopMargin(model, rate_limits(model.override_ramp_s)) {}

FeedStopMargin::FeedStopMargin(const MachineModel& model, const RateLimits& rates) noexcept
    : count_(limited_count(model)),
      rates_(rates),
      room_(RateRoom::of_jerk(rates.slope_per_s, rates.curvature_per_s2)) {
  for (int i = 0; i < count_; ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    hold_.caps.acceleration[i] = 1 / (kShare * limits.acceleration);
    hold_.caps.jerk[i] = 1 / (kShare * limits.jerk);
    fault_.caps.acceleration[i] =
        1 / (kShare * std::max(limits.acceleration, limits.fault_acceleration));
    fault_.caps.jerk[i] = 1 / (kShare * std::max(limits.jerk, limits.fault_jerk));
  }
}

void FeedStopMargin::begin(const CellGrid& grid, std::int64_t rest_cell) noexcept {
  grid_ = &grid;
  rest_cell_ = rest_cell;
  blocks_.begin(grid, rest_cell);
  hold_.last = fault_.last = {};  // what is granted follows from the window alone
}

void FeedStopMargin::grant(std::span<const FeedPiece> pieces, std::span<TimePiece> times) noexcept {
  if (grant(StopStretch(*grid_, pieces, times), times)) return;
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const auto time = times.subspan(n, 1);
    (void)grant(StopStretch(*grid_, pieces.subspan(n, 1), time), time);
  }
}

bool FeedStopMargin::grant(const StopStretch& stretch, std::span<TimePiece> times) noexcept {
  const bool is_tail = times.front().is_tail, is_alone = times.size() == 1;
  std::span<const double> rates;
  if (is_alone) rates = is_tail ? std::span<const double>(kTailRates) : kRates;
  const Grant hold = find(hold_, stretch, rates);
  if (!is_alone && !(hold.authority.jerk > 0)) return false;
  const Grant fault = find(fault_, stretch, rates);
  if (!is_alone && !(fault.authority.jerk > 0)) return false;
  SlowGrant slow_hold, slow_fault;
  const StopStretch slow = stretch.at_rate(kSlow);
  if (!is_tail || hold.velocity != kAnyVelocity) slow_hold = find_slow(hold_.caps, slow);
  if (!is_tail || fault.velocity != kAnyVelocity) slow_fault = find_slow(fault_.caps, slow);
  const double slow_velocity = kSlow * stretch.min_velocity();
  for (TimePiece& time : times) {
    time.stop_accel = hold.authority.accel;
    time.stop_jerk = hold.authority.jerk;
    time.stop_velocity = hold.velocity;
    time.fault_accel = fault.authority.accel;
    time.fault_jerk = fault.authority.jerk;
    time.fault_velocity = fault.velocity;
    time.slow_velocity = slow_velocity;
    time.slow_stop_accel = slow_hold.slow.accel;
    time.slow_stop_jerk = slow_hold.slow.jerk;
    time.slow_fault_accel = slow_fault.slow.accel;
    time.slow_fault_jerk = slow_fault.slow.jerk;
    time.rest_stop_accel = slow_hold.rest.accel;
    time.rest_stop_jerk = slow_hold.rest.jerk;
    time.rest_fault_accel = slow_fault.rest.accel;
    time.rest_fault_jerk = slow_fault.rest.jerk;
  }
  return true;
}

StopMargin FeedStopMargin::max_in(const Caps& caps, const StopStretch& stretch) const noexcept {
  double accel = kTiny, jerk = kTiny;
  for (const StopStretch::Part& part : stretch.parts()) {
    const CellBound::Values& rate = (*grid_)[part.cell].bound.rate;
    accel = std::max(accel, (rate * caps.acceleration).maxCoeff());
    jerk = std::max(jerk, (rate * caps.jerk).maxCoeff());
  }
  return {1 / accel, 1 / jerk};
}

StopMargin FeedStopMargin::allowed_at_rest(const Caps& caps, std::int64_t first,
                                           std::int64_t last) const noexcept {
  double accel = kTiny, jerk = kTiny;
  for (std::int64_t k = first; k <= last; ++k) {
    const FeedCell& here = (*grid_)[k];
    accel = std::max(accel, (here.bound.rate * caps.acceleration).maxCoeff());
    jerk = std::max(jerk, (here.bound.rate * caps.jerk).maxCoeff() / here.made_tight);
  }
  return {1 / accel, 1 / jerk};
}

FeedStopMargin::SlowGrant FeedStopMargin::find_slow(const Caps& caps,
                                                    const StopStretch& stretch) const noexcept {
  const StopMargin largest = max_in(caps, stretch);
  const Reach slow = lessen(caps, stretch, largest, largest);
  if (!(slow.authority.jerk > 0)) return {};
  const std::int64_t first = stretch.parts().front().cell;
  return {slow.authority, allowed_at_rest(caps, first, slow.farthest)};
}

FeedStopMargin::Grant FeedStopMargin::find(Search& search, const StopStretch& stretch,
                                           std::span<const double> rates) const noexcept {
  const StopMargin largest = max_in(search.caps, stretch);
  StopMargin got;
  if (search.last.jerk > 0) {
    const StopMargin start{std::min(largest.accel, kMaxGrowth * search.last.accel),
                           std::min(largest.jerk, kMaxGrowth * search.last.jerk)};
    got = lessen(search.caps, stretch, start, largest).authority;
  }
  if (!(got.jerk > 0)) got = lessen(search.caps, stretch, largest, largest).authority;
  search.last = got;
  if (got.jerk > 0) return {got, kAnyVelocity};
  for (const double rate : rates) {
    const StopStretch slower = stretch.at_rate(rate);
    got = lessen(search.caps, slower, largest, largest).authority;
    if (got.jerk > 0) return {got, slower.min_velocity()};
  }
  return {};
}

FeedStopMargin::Reach FeedStopMargin::lessen(const Caps& caps, const StopStretch& stretch,
                                             StopMargin now,
                                             const StopMargin& largest) const noexcept {
  const double deceleration = stretch.max_deceleration();
  for (int round = 0; round < kMarginRounds; ++round) {
    double depth = depth_of(stretch.end(), now.jerk);
    for (const StopStretch::Part& part : stretch.parts()) {
      depth = std::max(depth, depth_of(part.begin, now.jerk));
    }
    now.accel = std::min(now.accel, 1.02 * depth);
    const Use use = use_of(caps, stretch, now);
    if (use.is_too_far || use.is_too_fast) break;
    if (use.is_within()) {
      const bool is_close = use.farthest + 2 >= rest_cell_;
      if (is_close && !ends_before_plan(stretch, now)) break;
      return {now, use.farthest};
    }
    if (use.acceleration > 1) now.accel *= kLess / std::min(use.acceleration, 2.0);
    if (use.jerk > 1) {
      const Cause cause = cause_of(caps, use);
      if (cause.by_speed >= 1) break;  // too fast whatever the stop does
      const double rest = use.jerk - cause.by_speed;
      const double by = std::max(0.3, kLess * (1 - cause.by_speed) / rest);
      now.jerk *= by;
      if (cause.by_depth > 0.3 * rest) now.accel *= by;
    }
    if (now.jerk < kHopeless * largest.jerk || now.accel < kHopeless * largest.accel) break;
    if (now.accel < kEasing * deceleration) break;
  }
  return {};
}

bool FeedStopMargin::ends_before_plan(const StopStretch& stretch,
                                      const StopMargin& authority) const noexcept {
  double end = 0;
  for (std::int64_t k = stretch.parts().front().cell; k < rest_cell_; ++k) end += (*grid_)[k].h;
  const auto rest = [&](const PathState& p) { return p.s + StopLaw(p, authority).distance(); };
  const auto parts = stretch.parts();
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const StopStretch::Part& from = parts[part];
    const bool is_last = part + 1 == parts.size();
    const std::array<double, 5> rests = {rest(from.begin), rest(from.between[0]),
                                         rest(from.between[1]), rest(from.between[2]),
                                         rest(is_last ? stretch.end() : parts[part + 1].begin)};
    double farthest = std::max(rests[0], rests[4]), bend = 0;
    for (std::size_t n = 1; n + 1 < rests.size(); ++n) {
      farthest = std::max(farthest, rests[n]);
      bend = std::max(bend, std::abs(rests[n - 1] - 2 * rests[n] + rests[n + 1]));
    }
    if (!(farthest + bend / 4 <= end + kRounding_mm)) return false;
  }
  return true;
}

bool FeedStopMargin::rises_too_far(const FeedCell& cell, const PathState& begin, double in_cell,
                                   double jerk) noexcept {
  if (!(begin.dds > 0)) return false;
  const double peak = square(begin.ds + 0.5 * begin.dds * begin.dds / jerk);
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    const double ahead = cell.h * k / FeedCell::kSteps - in_cell;
    if (ahead < 0) continue;
    const double v2 = std::min(peak, square(begin.ds) + 2 * begin.dds * ahead);
    if (v2 > kFast * cell.at[static_cast<std::size_t>(k)].max_b) return true;
    if (v2 == peak) break;
  }
  return false;
}

FeedStopMargin::Motion FeedStopMargin::motion_in_cell(const StopWalk& walk,
                                                      double by_rate) noexcept {
  const PathState& from = walk.from();
  const double rising = std::max(from.dds, 0.0) + by_rate;
  const double v2 = walk.max_v2();
  const double speed = std::sqrt(v2), v3 = v2 * speed;
  const double sinking = 3 * std::min(walk.largest_product(),
                                      speed * std::max(walk.authority().accel, by_rate - from.dds));
  return {v2, v3, rising, sinking, 3 * speed * rising};
}

bool FeedStopMargin::passes(const Caps& caps, const CellBlock& block, const StopWalk& walk,
                            const Use& use) const noexcept {
  const double v2 = walk.max_v2_ahead(), speed = std::sqrt(v2);
  if (v2 > StopWalk::kBetweenSteps * kFast * block.max_b) return false;
  const double depth = std::max(walk.authority().accel, -walk.from().dds);
  const double sinking = 3 * std::min(walk.largest_product(), speed * depth);
  const Share share =
      share_of(caps, block.bound, block.made_tight, walk.bounds(), {v2, v2 * speed, 0, sinking, 0});
  return share.acceleration <= std::max(1.0, use.acceleration) &&
         share.jerk <= std::max(1.0, use.jerk);
}

double FeedStopMargin::jerk_to_rest(const PathState& p, double rate) const noexcept {
  if (!(p.dds < 0) || !(p.ds > 0)) return 0;
  // (w² s'' + w' s')²/(2 w s') = w³ s''²/2s' + w w' s'' + w'² s'/2w. Of the last, 2Ω₂ w and
  // 2Ω₂(1-w) bound w'². At a rate of 1 w' is small, at lower ones it may be all of the slope.
  const double own = 0.5 * p.dds * p.dds / p.ds, planned_velocity = p.ds / rate;
  const double falling =
      rate < 1 ? own - rates_.slope_per_s * p.dds / rate : room_.largest(own, -p.dds);
  return kShare * (falling + rates_.curvature_per_s2 * planned_velocity);
}

FeedStopMargin::Use FeedStopMargin::use_of(const Caps& caps, const StopStretch& stretch,
                                           const StopMargin& authority) const noexcept {
  const auto parts = stretch.parts();
  const auto walk_from = [&](std::size_t n) {
    if (n == parts.size()) {
      StopWalk walk(stretch.end(), authority, parts.back().cell_begin);
      walk.raise_jerk(jerk_to_rest(stretch.end(), stretch.rate()));
      return walk;
    }
    StopWalk walk(parts[n].begin, authority, parts[n].cell_begin);
    walk.raise_jerk(jerk_to_rest(parts[n].begin, stretch.rate()));
    for (const PathState& between : parts[n].between) {
      walk.raise_jerk(jerk_to_rest(between, stretch.rate()));
    }
    return walk;
  };
  Use use;
  StopWalk walk = walk_from(0);
  for (std::size_t n = 0; n < parts.size() && use.is_within(); ++n) {
    StopWalk next = walk_from(n + 1);
    const bool is_below = walk.stays_below(next, parts[n].duration);
    const std::int64_t end = is_below ? parts[n].cell + 1 : kNoEnd;
    add_use(caps, parts[n].cell, end, stretch.rate(), walk, use);
    if (is_below) {
      next.raise_product(walk.largest_product());
      next.raise_jerk(walk.bounds().jerk);
    }
    walk = next;
  }
  if (use.is_within()) add_use(caps, parts.back().cell, kNoEnd, stretch.rate(), walk, use);
  return use;
}

void FeedStopMargin::add_use(const Caps& caps, std::int64_t cell, std::int64_t end, double rate,
                             StopWalk walk, Use& use) const noexcept {
  const PathState begin = walk.from();
  const double in_cell = begin.s - walk.s();
  const StopMargin authority = walk.authority();
  for (std::int64_t k = cell; k < end && walk.is_moving();) {
    if (k >= rest_cell_) {
      use.is_too_far = true;
      return;
    }
    walk.enter();
    const CellBlock* block = k > cell && walk.is_braking() ? blocks_.find(k) : nullptr;
    if (block != nullptr && passes(caps, *block, walk, use)) {
      for (std::size_t n = 0; n < block->h.size() && walk.is_moving(); ++n, ++k) {
        walk.pass(block->h[n]);
      }
      use.farthest = std::max(use.farthest, k - 1);
      continue;
    }
    const FeedCell& here = (*grid_)[k];
    const double by_rate = k == cell ? rates_.slope_per_s * begin.ds / rate : 0;
    const Motion motion = motion_in_cell(walk, by_rate);
    use.is_too_fast = k > cell ? motion.v2 > StopWalk::kBetweenSteps * kFast * here.max_b
                               : rises_too_far(here, begin, in_cell, authority.jerk);
    if (use.is_too_fast) return;
    const Share share = share_of(caps, here.bound, here.made_tight, walk.bounds(), motion);
    use.acceleration = std::max(use.acceleration, share.acceleration);
    if (share.jerk > use.jerk) {
      use.jerk = share.jerk;
      use.cell = k;
      use.motion = motion;
    }
    walk.pass(here.h);
    use.farthest = std::max(use.farthest, k++);
  }
}

FeedStopMargin::Share FeedStopMargin::share_of(const Caps& caps, const CellBound& at,
                                               double made_tight, const StopMargin& authority,
                                               const Motion& m) noexcept {
  using Values = CellBound::Values;
  const Values up = at.d1.up * m.rising + at.d1.down * authority.accel + at.d2.up * m.v2;
  const Values down = at.d1.down * m.rising + at.d1.up * authority.accel + at.d2.down * m.v2;
  const Values bend_up = at.d2.down * m.sinking_v + at.d2.up * m.rising_v + at.d3.up * m.v3;
  const Values bend_down = at.d2.up * m.sinking_v + at.d2.down * m.rising_v + at.d3.down * m.v3;
  const Values jerk = (at.rate * authority.jerk + bend_up.max(bend_down)) * caps.jerk;
  // Beside the pole rounding shows in third differences of a stop as in those of the plan.
  return {(up.max(down) * caps.acceleration).eval().maxCoeff(), jerk.maxCoeff() / made_tight};
}

FeedStopMargin::Cause FeedStopMargin::cause_of(const Caps& caps, const Use& use) const noexcept {
  const FeedCell& here = (*grid_)[use.cell];
  const CellBound& at = here.bound;
  const Motion& m = use.motion;
  Cause cause;
  double largest = 0;
  for (int i = 0; i < count_; ++i) {
    const double depth_up = at.d2.down[i] * m.sinking_v + at.d2.up[i] * m.rising_v;
    const double depth_down = at.d2.up[i] * m.sinking_v + at.d2.down[i] * m.rising_v;
    const double speed_up = at.d3.up[i] * m.v3, speed_down = at.d3.down[i] * m.v3;
    const bool is_up = depth_up + speed_up > depth_down + speed_down;
    const double depth = is_up ? depth_up : depth_down, speed = is_up ? speed_up : speed_down;
    const double per_jerk = caps.jerk[i] / here.made_tight;
    if ((depth + speed) * per_jerk <= largest) continue;
    largest = (depth + speed) * per_jerk;
    cause = {depth * per_jerk, speed * per_jerk};
  }
  return cause;
}

}  // namespace meridian
