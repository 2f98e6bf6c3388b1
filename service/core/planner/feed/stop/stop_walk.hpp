// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "meridian/cycle/stop/stop_law.hpp"
#include "meridian/planner/stop_product.hpp"
#include "meridian/planner/time_law.hpp"

namespace meridian {

/// A stop on its path through cells, in even steps of time: the state that it has at the begin of
/// each cell, and bounds of it from there on. The first cell begins at s = `cell_begin`. RT: no
/// allocation.
class StopWalk {
 public:
  StopWalk(const PathState& begin, const StopMargin& authority, double cell_begin = 0) noexcept
      : authority_(authority),
        law_(begin, authority),
        rest_(begin.s + law_.distance()),
        largest_product_(largest_stop_product(peak_of(begin), authority.accel, authority.jerk)),
        largest_jerk_(authority.jerk),
        rounding_(kRounding * peak_v2_of(begin)),
        from_(begin),
        to_(begin),
        s_(cell_begin) {}

  [[nodiscard]] const StopMargin& authority() const noexcept { return authority_; }
  /// Whether it still moves at the begin of the cell.
  [[nodiscard]] bool is_moving() const noexcept { return s_ + kRounding_mm < rest_; }
  /// State at the step before the begin of the cell.
  [[nodiscard]] const PathState& from() const noexcept { return from_; }
  /// s at the begin of the cell.
  [[nodiscard]] double s() const noexcept { return s_; }
  /// Whether it is slower from there on.
  [[nodiscard]] bool is_braking() const noexcept { return !(from_.dds > 0); }
  /// Largest v |a| of the stop, and of every slower one.
  [[nodiscard]] double largest_product() const noexcept { return largest_product_; }
  /// It stands for another stop too, whose v |a| may be as large as that.
  void raise_product(double other) noexcept {
    largest_product_ = std::max(largest_product_, other);
  }

  /// Acceleration and jerk that bound what it does.
  [[nodiscard]] StopMargin bounds() const noexcept { return {authority_.accel, largest_jerk_}; }
  /// It stands for stops too that end a braking of their own by as much jerk.
  void raise_jerk(double other) noexcept { largest_jerk_ = std::max(largest_jerk_, other); }

  /// Whether it is nowhere faster than `next` from where that begins: a stop of the same plan under
  /// the same authority, from `duration` later. Neither may have entered a cell yet.
  ///
  /// It arrives there slower and with no more acceleration, and comes later to every s behind. So
  /// at the same s and speed it would have less acceleration, which lets no stop come from below.
  /// If it arrives on its last phase, its speed alone is enough: at that speed no stop decelerates
  /// harder. Not where one of them eases off from a harder deceleration than `accel`, or ends the
  /// plan's own braking with another jerk: there acceleration does not fall first.
  [[nodiscard]] bool stays_below(const StopWalk& next, double duration) const noexcept {
    const PathState& begin = next.from_;
    if (lets_go_at_once(from_) || lets_go_at_once(begin)) return false;
    const PathState at = law_.at(duration);
    const double fastest = at.dds > 0 ? peak_of(at) : at.ds;
    return at.s <= begin.s && fastest <= begin.ds && (at.dds <= begin.dds || is_in_last_phase(at));
  }

  /// Largest ṡ² from the begin of the cell on.
  [[nodiscard]] double max_v2() const noexcept {
    const double x = to_.s > from_.s ? std::clamp((s_ - from_.s) / (to_.s - from_.s), 0.0, 1.0) : 0;
    const double v2 =
        kBetweenSteps * (from_.ds * from_.ds + x * (to_.ds * to_.ds - from_.ds * from_.ds));
    return is_braking() ? v2 : std::max(v2, kBetweenSteps * peak_v2_of(from_));
  }
  /// The same where it brakes, for all cells from this one on, rounding included.
  [[nodiscard]] double max_v2_ahead() const noexcept {
    return (1 + kRounding) * max_v2() + rounding_;
  }

  /// Goes on to the step before the begin of the cell.
  void enter() noexcept {
    while (to_.s <= s_ && step_ < kSteps) {
      from_ = to_;
      to_ = law_.at(law_.duration() * ++step_ / kSteps);
    }
  }
  /// The cell, of length `h`, lies behind: the next one begins.
  void pass(double h) noexcept { s_ += h; }

  static constexpr double kBetweenSteps = 1.002;  ///< on ṡ² between the steps

 private:
  static constexpr int kSteps = 24;
  static constexpr double kRounding_mm = 1e-9;
  static constexpr double kRounding = 1e-6;  ///< far above that of ṡ² between the three phases

  /// Whether a stop from there lets go of its deceleration at once: more of it is not allowed, or
  /// the speed would be gone before it is.
  [[nodiscard]] bool lets_go_at_once(const PathState& p) const noexcept {
    return -p.dds > authority_.accel || (p.dds < 0 && p.dds * p.dds >= 2 * authority_.jerk * p.ds);
  }
  [[nodiscard]] bool is_in_last_phase(const PathState& p) const noexcept {
    return p.dds < 0 && p.dds * p.dds >= 2 * (1 - kRounding) * authority_.jerk * p.ds;
  }
  /// Highest speed of a stop from there.
  [[nodiscard]] double peak_of(const PathState& p) const noexcept {
    return p.ds + 0.5 * p.dds * p.dds / authority_.jerk;
  }
  [[nodiscard]] double peak_v2_of(const PathState& p) const noexcept {
    return peak_of(p) * peak_of(p);
  }

  StopMargin authority_;
  StopLaw law_;
  double rest_ = 0, largest_product_ = 0, largest_jerk_ = 0, rounding_ = 0;
  PathState from_, to_;
  double s_ = 0;  ///< begin of the cell
  int step_ = 0;
};

}  // namespace meridian
