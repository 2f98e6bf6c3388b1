// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace meridian::drives {

/// How a simulated drive powers up, and what its homing comes to.
struct HomingPlan {
  bool is_referenced = true;  ///< knows where it is; else it stands beside home and calls that 0
  bool fails = false;         ///< it says that it found no reference
  bool hangs = false;         ///< it searches for ever
};

/// Bits of object 6041h in homing mode. Source: CiA 402-2.
inline constexpr std::uint16_t kStatusTargetReached = 0x0400;
inline constexpr std::uint16_t kStatusHomingAttained = 0x1000;
inline constexpr std::uint16_t kStatusHomingError = 0x2000;

/// A drive in homing mode: it creeps to its reference switch and from then on calls that place by
/// its name. Time is an argument. Proof: tests/unit/drives/drive_test.cpp.
class HomingSearch {
 public:
  /// `velocity`: of the search. The switch is at `reference`, as positions are to be called;
  /// `offset` is what the drive calls them too little until it has found it.
  HomingSearch(const HomingPlan& plan, double reference, double offset, double velocity)
      : plan_(plan), reference_(reference), offset_(offset), velocity_(velocity) {}

  [[nodiscard]] bool is_referenced() const noexcept { return plan_.is_referenced; }
  [[nodiscard]] bool is_searching() const noexcept { return state_ == State::kSearching; }

  /// What bit 4 of the controlword asks for, in homing mode and operation enabled.
  void ask(bool is_start) noexcept {
    if (is_start && !was_start_) {
      state_ = State::kSearching;
      plan_.is_referenced = false;
      searched_s_ = 0;
    } else if (!is_start && state_ == State::kSearching) {
      state_ = State::kIdle;  // interrupted
    }
    was_start_ = is_start;
  }

  /// One period of the search: moves `target`. Returns what positions are to be called more from
  /// now on, 0 until the drive stands on its reference.
  [[nodiscard]] double work(double& target, double position, double dt_s) noexcept {
    constexpr double kSearchesBeforeItFails_s = 0.05, kThere = 1e-6;
    if (state_ != State::kSearching) return 0;
    searched_s_ += dt_s;
    if (plan_.hangs) return 0;
    if (plan_.fails && searched_s_ > kSearchesBeforeItFails_s) {
      state_ = State::kFailed;
      return 0;
    }
    const double there = reference_ - offset_, step = velocity_ * dt_s;
    target += std::clamp(there - target, -step, step);
    if (target != there || std::abs(position - there) > kThere) return 0;
    state_ = State::kAttained;
    plan_.is_referenced = true;
    return std::exchange(offset_, 0);
  }

  [[nodiscard]] std::uint16_t statusword_bits() const noexcept {
    switch (state_) {
      case State::kIdle:
        return kStatusTargetReached;
      case State::kSearching:
        return 0;
      case State::kAttained:
        return kStatusTargetReached | kStatusHomingAttained;
      case State::kFailed:
        return kStatusTargetReached | kStatusHomingError;
    }
    return 0;
  }

 private:
  enum class State : std::uint8_t { kIdle, kSearching, kAttained, kFailed };
  HomingPlan plan_;
  double reference_, offset_, velocity_;
  State state_ = State::kIdle;
  bool was_start_ = false;
  double searched_s_ = 0;
};

}  // namespace meridian::drives
