// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/drive_hardware.hpp"
#include "service/drives/kit/csp/homing_run.hpp"

namespace meridian::drive {

inline constexpr std::int64_t kModeHoming = 6, kModeCsp = 8;

/// A drive's own search for its reference: mode 6, then bit 4 of 6040h, then what 6041h says. A
/// drive that is still at the result of the search before it has to show a new one, or to stand by
/// it for 0.1 s (methods without motion). RT. Source: CiA 402-2, homing mode.
/// Proof: tests/unit/drive_kit/csp_homing_test.cpp.
class CspHoming {
 public:
  static constexpr std::uint16_t kStart = 0x10;  ///< bit 4 of 6040h in mode 6

  /// Before a period; `is_wanted`: Output::is_homing.
  void want(bool is_wanted) noexcept {
    if (!is_wanted) {
      state_ = State::kIdle;
    } else if (state_ == State::kIdle) {
      state_ = State::kMode;
    }
  }
  /// After a period. `is_in_mode`: the drive is enabled and shows mode 6, or shows none.
  void see(std::uint16_t statusword, bool is_in_mode) noexcept {
    if (!is_in_mode) return;
    if (state_ == State::kMode) {
      state_ = State::kAsked;
      asked_s_ = 0;
      return;
    }
    if (state_ != State::kAsked && state_ != State::kSearching) return;
    const bool is_over = (statusword & kStatusTargetReached) != 0;
    const bool has_failed = (statusword & kStatusHomingError) != 0;
    const bool is_attained = is_over && (statusword & kStatusHomingAttained) != 0;
    const bool counts = state_ == State::kSearching || asked_s_ > kWithoutMotion_s;
    if (!has_failed && !is_attained) {
      state_ = State::kSearching;
    } else if (counts) {
      state_ = has_failed ? State::kFailed : State::kAttained;
    }
  }
  void pass(double dt_s) noexcept { asked_s_ += dt_s; }

  [[nodiscard]] bool is_wanted() const noexcept { return state_ != State::kIdle; }
  /// Bit 4 of the controlword.
  [[nodiscard]] std::uint16_t controlword_bits() const noexcept {
    return state_ == State::kIdle || state_ == State::kMode ? 0 : kStart;
  }
  [[nodiscard]] HomingState result() const noexcept {
    if (state_ == State::kAttained) return HomingState::kAttained;
    return state_ == State::kFailed ? HomingState::kFailed : HomingState::kSearching;
  }

 private:
  enum class State : std::uint8_t { kIdle, kMode, kAsked, kSearching, kAttained, kFailed };
  static constexpr double kWithoutMotion_s = 0.1;

  State state_ = State::kIdle;
  double asked_s_ = 0;
};

}  // namespace meridian::drive
