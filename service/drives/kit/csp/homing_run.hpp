// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "meridian/drive_axis.hpp"
#include "meridian/drive_hardware.hpp"

namespace meridian::drive {

/// Bits of object 6041h in homing mode. Source: CiA 402-2.
inline constexpr std::uint16_t kStatusTargetReached = 0x0400;
inline constexpr std::uint16_t kStatusHomingAttained = 0x1000;
inline constexpr std::uint16_t kStatusHomingError = 0x2000;

/// An axis in homing mode: whether it searches, what came of it, and where its method leads it.
/// Time is an argument. Proof: tests/unit/drive_kit/homing_run_test.cpp.
class HomingRun {
 public:
  /// `acceleration`: of a search by the index pulse; 0: its velocity may step.
  HomingRun(const HomingSpec& spec, double acceleration) noexcept
      : spec_(spec),
        acceleration_(acceleration > 0 ? acceleration : INFINITY),
        is_referenced_(spec.is_referenced) {}

  [[nodiscard]] bool is_referenced() const noexcept { return is_referenced_; }
  [[nodiscard]] bool is_searching() const noexcept {
    return state_ == State::kBegins || state_ == State::kSearching;
  }
  [[nodiscard]] bool is_by_drive() const noexcept { return spec_.method == HomingMethod::kByDrive; }
  /// Whether the library keeps what positions are called more; else the hardware does.
  [[nodiscard]] bool owns_names() const noexcept { return spec_.method == HomingMethod::kByIndex; }

  /// What bit 4 of the controlword asks for, in homing mode and operation enabled.
  void ask(bool is_start) noexcept {
    if (is_start && !was_start_) {
      state_ = State::kBegins;
      is_referenced_ = false;
      index_.reset();
      searched_ = 0;
    } else if (!is_start && is_searching()) {
      state_ = State::kIdle;  // interrupted
    }
    was_start_ = is_start;
  }
  /// The axis stands: what it was led with before is over.
  void stand() noexcept { velocity_ = 0; }

  /// One period in homing mode. Where nothing is searched, an axis that still moves ramps down.
  [[nodiscard]] HomingStep work(HomingView view, const Reading& reading, int axis,
                                Hardware& hardware) noexcept {
    if (!is_searching()) return ramp(view, 0);
    view.is_begin = std::exchange(state_, State::kSearching) == State::kBegins;
    switch (spec_.method) {
      case HomingMethod::kNone:
        return end({HomingState::kAttained, view.target, 0, 0});
      case HomingMethod::kByDrive: {
        HomingStep step = hardware.home(axis, view);
        step.target = view.position;
        return end(step);
      }
      case HomingMethod::kByCallback:
        return end(hardware.home(axis, view));
      case HomingMethod::kByIndex:
        return end(search_index(view, reading));
    }
    return end({HomingState::kFailed, view.target, 0, 0});
  }

  [[nodiscard]] std::uint16_t statusword_bits() const noexcept {
    switch (state_) {
      case State::kIdle:
        return kStatusTargetReached;
      case State::kBegins:
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
  enum class State : std::uint8_t { kIdle, kBegins, kSearching, kAttained, kFailed };

  [[nodiscard]] HomingStep end(const HomingStep& step) noexcept {
    if (step.state == HomingState::kAttained) state_ = State::kAttained;
    if (step.state == HomingState::kFailed) state_ = State::kFailed;
    is_referenced_ = state_ == State::kAttained;
    return step;
  }
  /// Leads the target on, its velocity towards `wanted`.
  [[nodiscard]] HomingStep ramp(const HomingView& view, double wanted) noexcept {
    const double before = velocity_, max_change = acceleration_ * view.dt_s;
    velocity_ += std::clamp(wanted - velocity_, -max_change, max_change);
    const bool stands = before == 0 && velocity_ == 0;
    const double distance = stands ? 0 : 0.5 * (before + velocity_) * view.dt_s;
    return {HomingState::kSearching, stands ? view.target : view.target + distance, velocity_, 0};
  }
  [[nodiscard]] HomingStep search_index(const HomingView& view, const Reading& reading) noexcept {
    if (!index_ && reading.is_index && !view.is_begin) index_ = reading.index_position;
    const bool is_beyond = spec_.search_distance > 0 && searched_ > spec_.search_distance;
    HomingStep step = ramp(view, index_ || is_beyond ? 0 : spec_.search_velocity);
    searched_ += std::abs(step.target - view.target);
    if (step.velocity != 0) return step;
    if (index_) {
      step.state = HomingState::kAttained;
      step.shift = spec_.index_position - *index_;
    } else {
      step.state =
          HomingState::kFailed;  // it went the whole distance, or has no velocity to go with
    }
    return step;
  }

  HomingSpec spec_;
  double acceleration_;
  State state_ = State::kIdle;
  bool is_referenced_, was_start_ = false;
  std::optional<double> index_;  ///< where the pulse was
  double searched_ = 0, velocity_ = 0;
};

}  // namespace meridian::drive
