// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "meridian/drive_hardware.hpp"

namespace meridian::drives {

/// How a simulated drive powers up, and what its homing comes to.
struct HomingPlan {
  bool is_referenced = true;  ///< knows where it is; else it stands beside home and calls that 0
  bool fails = false;         ///< it says that it found no reference
  bool hangs = false;         ///< it searches for ever
};

/// A simulated search: the drive creeps to its reference switch and from then on calls that place
/// by its name. Time is an argument. Proof: tests/unit/simulated_drives/drive_test.cpp.
class HomingSearch {
 public:
  /// `velocity`: of the search. The switch is at `reference`, as positions are to be called;
  /// `offset` is what the drive calls them too little until it has found it.
  HomingSearch(const HomingPlan& plan, double reference, double offset, double velocity)
      : plan_(plan), reference_(reference), offset_(offset), velocity_(velocity) {}

  /// One period of the search. The step's shift is 0 until the drive stands on its reference.
  [[nodiscard]] drive::HomingStep work(const drive::HomingView& view) noexcept {
    constexpr double kSearchesBeforeItFails_s = 0.05, kThere = 1e-6;
    drive::HomingStep step;
    step.target = view.target;
    if (view.is_begin) searched_s_ = 0;
    searched_s_ += view.dt_s;
    if (plan_.hangs) return step;
    if (plan_.fails && searched_s_ > kSearchesBeforeItFails_s) {
      step.state = drive::HomingState::kFailed;
      return step;
    }
    const double there = reference_ - offset_, max_step = velocity_ * view.dt_s;
    step.target += std::clamp(there - view.target, -max_step, max_step);
    if (step.target != there || std::abs(view.position - there) > kThere) return step;
    step.state = drive::HomingState::kAttained;
    step.shift = std::exchange(offset_, 0);
    return step;
  }

 private:
  HomingPlan plan_;
  double reference_, offset_, velocity_;
  double searched_s_ = 0;
};

}  // namespace meridian::drives
