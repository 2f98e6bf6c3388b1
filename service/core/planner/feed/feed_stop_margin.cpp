// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/feed_stop_margin.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/planner/rate_limits.hpp"
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
constexpr double kFast = 1.0002;  // on ṡ² that feed and velocity allow: what a plan may use
constexpr double kSlow = 0.6;     // rate of plan time below which slow_* may be used
/// Rates of plan time at which authority is sought where there is none at the full rate.
constexpr double kRates[] = {0.97, 0.94, 0.9, 0.85, 0.78, 0.7, 0.6, 0.45, 0.3, 0.15};

/// The plan's state at another rate of plan time.
PathState slowed(const PathState& p, double rate) noexcept {
  return {p.s, rate * p.ds, rate * rate * p.dds, 0};
}

/// Deepest deceleration of a stop that nothing but its jerk bounds.
double depth_of(const PathState& p, double jerk) noexcept {
  return std::sqrt(jerk * p.ds + 0.5 * p.dds * p.dds);
}

}  // namespace

FeedStopMargin::FeedStopMargin(const MachineModel& model) noexcept
    : count_(limited_count(model)), slope_(rate_limits(model.override_ramp_s).slope_per_s) {
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

FeedStopMargin::Ends FeedStopMargin::Ends::at_rate(double rate) const noexcept {
  Ends out{slowed(begin, rate), slowed(end, rate), {}};
  for (std::size_t n = 0; n < between.size(); ++n) out.between[n] = slowed(between[n], rate);
  return out;
}

void FeedStopMargin::grant(const FeedPiece& piece, TimePiece& time) noexcept {
  const auto state = [&](double share) {
    PathState at = state_at(time, share * time.duration);
    at.s -= (*grid_)[piece.cell].x;
    return at;
  };
  const Ends ends{state(0), state(1), {state(0.25), state(0.5), state(0.75)}};
  const Grant hold = find(hold_, piece.cell, ends, !time.is_tail);
  time.stop_accel = hold.authority.accel;
  time.stop_jerk = hold.authority.jerk;
  time.stop_velocity = hold.velocity;
  const Grant fault = find(fault_, piece.cell, ends, !time.is_tail);
  time.fault_accel = fault.authority.accel;
  time.fault_jerk = fault.authority.jerk;
  time.fault_velocity = fault.velocity;
  time.slow_velocity = kSlow * std::min(ends.begin.ds, ends.end.ds);
  if (time.is_tail) return;
  const Ends slow = ends.at_rate(kSlow);
  const StopMargin slow_hold = find(hold_.caps, piece.cell, slow);
  time.slow_stop_accel = slow_hold.accel;
  time.slow_stop_jerk = slow_hold.jerk;
  const StopMargin slow_fault = find(fault_.caps, piece.cell, slow);
  time.slow_fault_accel = slow_fault.accel;
  time.slow_fault_jerk = slow_fault.jerk;
}

StopMargin FeedStopMargin::max_in(const Caps& caps, std::int64_t cell) const noexcept {
  const CellBound::Values& rate = (*grid_)[cell].bound.rate;
  return {1 / std::max(kTiny, (rate * caps.acceleration).maxCoeff()),
          1 / std::max(kTiny, (rate * caps.jerk).maxCoeff())};
}

StopMargin FeedStopMargin::find(const Caps& caps, std::int64_t cell,
                                const Ends& ends) const noexcept {
  const StopMargin largest = max_in(caps, cell);
  return lessen(caps, cell, ends, largest, largest);
}

FeedStopMargin::Grant FeedStopMargin::find(Search& search, std::int64_t cell, const Ends& ends,
                                           bool is_slower_good) const noexcept {
  const StopMargin largest = max_in(search.caps, cell);
  StopMargin got;
  if (search.last.jerk > 0) {
    const StopMargin start{std::min(largest.accel, kMaxGrowth * search.last.accel),
                           std::min(largest.jerk, kMaxGrowth * search.last.jerk)};
    got = lessen(search.caps, cell, ends, start, largest);
  }
  if (!(got.jerk > 0)) got = lessen(search.caps, cell, ends, largest, largest);
  search.last = got;
  if (got.jerk > 0) return {got, kAnyVelocity};
  if (!is_slower_good) return {};
  for (const double rate : kRates) {
    const Ends slower = ends.at_rate(rate);
    got = lessen(search.caps, cell, slower, largest, largest);
    if (got.jerk > 0) return {got, std::min(slower.begin.ds, slower.end.ds)};
  }
  return {};
}

StopMargin FeedStopMargin::lessen(const Caps& caps, std::int64_t cell, const Ends& from,
                                  StopMargin now, const StopMargin& largest) const noexcept {
  for (int round = 0; round < kMarginRounds; ++round) {
    const double depth = std::max(depth_of(from.begin, now.jerk), depth_of(from.end, now.jerk));
    now.accel = std::min(now.accel, 1.02 * depth);
    Use use;
    if (!add_use(caps, cell, from.begin, now, use)) break;
    if (use.is_within() && !add_use(caps, cell, from.end, now, use)) break;
    if (use.is_within()) {
      const bool is_close = use.farthest + 2 >= rest_cell_;
      return !is_close || ends_before_plan(cell, from, now) ? now : StopMargin{};
    }
    if (use.is_too_fast) break;
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
    if (now.accel < kEasing * std::max(-from.begin.dds, -from.end.dds)) break;
  }
  return {};
}

bool FeedStopMargin::ends_before_plan(std::int64_t cell, const Ends& from,
                                      const StopMargin& authority) const noexcept {
  double end = 0;
  for (std::int64_t k = cell; k < rest_cell_; ++k) end += (*grid_)[k].h;
  const auto rest = [&](const PathState& p) { return p.s + StopLaw(p, authority).distance(); };
  const std::array<double, 5> rests = {rest(from.begin), rest(from.between[0]),
                                       rest(from.between[1]), rest(from.between[2]),
                                       rest(from.end)};
  double farthest = std::max(rests[0], rests[4]), bend = 0;
  for (std::size_t n = 1; n + 1 < rests.size(); ++n) {
    farthest = std::max(farthest, rests[n]);
    bend = std::max(bend, std::abs(rests[n - 1] - 2 * rests[n] + rests[n + 1]));
  }
  return farthest + bend / 4 <= end + kRounding_mm;
}

bool FeedStopMargin::rises_too_far(const FeedCell& cell, const PathState& begin,
                                   double jerk) noexcept {
  if (!(begin.dds > 0)) return false;
  const double peak = square(begin.ds + 0.5 * begin.dds * begin.dds / jerk);
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    const double ahead = cell.h * k / FeedCell::kSteps - begin.s;
    if (ahead < 0) continue;
    const double v2 = std::min(peak, square(begin.ds) + 2 * begin.dds * ahead);
    if (v2 > kFast * cell.at[static_cast<std::size_t>(k)].max_b) return true;
    if (v2 == peak) break;
  }
  return false;
}

FeedStopMargin::Motion FeedStopMargin::motion_in_cell(const StopWalk& walk,
                                                      bool is_first) const noexcept {
  const PathState& from = walk.from();
  const double by_rate = is_first ? slope_ * from.ds : 0;  // of slower states
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
  const Share share = share_of(caps, block.bound, block.made_tight, walk.authority(),
                               {v2, v2 * speed, 0, sinking, 0});
  return share.acceleration <= std::max(1.0, use.acceleration) &&
         share.jerk <= std::max(1.0, use.jerk);
}

bool FeedStopMargin::add_use(const Caps& caps, std::int64_t cell, const PathState& begin,
                             const StopMargin& authority, Use& use) const noexcept {
  StopWalk walk(begin, authority);
  for (std::int64_t k = cell; walk.is_moving();) {
    if (k >= rest_cell_) return false;
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
    const Motion motion = motion_in_cell(walk, k == cell);
    const bool is_too_fast = k > cell ? motion.v2 > StopWalk::kBetweenSteps * kFast * here.max_b
                                      : rises_too_far(here, begin, authority.jerk);
    if (is_too_fast) {
      use.is_too_fast = true;
      return true;
    }
    const Share share = share_of(caps, here.bound, here.made_tight, authority, motion);
    use.acceleration = std::max(use.acceleration, share.acceleration);
    if (share.jerk > use.jerk) {
      use.jerk = share.jerk;
      use.cell = k;
      use.motion = motion;
    }
    walk.pass(here.h);
    use.farthest = std::max(use.farthest, k++);
  }
  return true;
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
