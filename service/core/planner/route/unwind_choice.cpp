// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/unwind_choice.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/winding.hpp"

namespace meridian {
namespace {

constexpr double kMaxTurns = 1000;  // travel is bounded to 1e5 deg
constexpr double kMargin_rad = 1e-9;

int whole_turns_in(double room) noexcept {
  return static_cast<int>(std::clamp(std::floor(room / kTurn_rad), 0.0, kMaxTurns));
}

}  // namespace

UnwindChoice::UnwindChoice(const JointLimits& limits, double at, double beyond) noexcept {
  const bool is_up = beyond > at;
  sign_ = is_up ? -1 : 1;
  const double room = is_up ? at - limits.travel_min : limits.travel_max - at;
  most_ = whole_turns_in(room + kMargin_rad);
  best_ = whole_turns_in(room - 0.5 * kTurn_rad);
}

int UnwindChoice::next() noexcept {
  // best, best - 1 .. 1, then best + 1 .. most
  ++tried_;
  if (tried_ <= best_) return sign_ * (best_ + 1 - tried_);
  return tried_ <= most_ ? sign_ * tried_ : 0;
}

}  // namespace meridian
