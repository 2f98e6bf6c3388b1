// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/rest_meter.hpp"

namespace meridian::simulate {
namespace {

/// Speeds nearer to each other than that are the same: rounding.
constexpr double kSame = 1e-6;

}  // namespace

void RestMeter::move(double speed, double time_s) {
  const bool is_slower = speed < top_ * (1 - kSame);
  if (sets_off_ && is_slower) {  // it has been fastest: from here on it comes to the next rest
    lost_s_ += ramp_.loss_s(top_);
    sets_off_ = false;
    ramp_ = {};
  }
  // The way to a rest begins where the speed last rose.
  if (!sets_off_ && speed > last_ * (1 + kSame)) {
    top_ = 0;
    ramp_ = {};
  }
  ramp_.time_s += time_s;
  ramp_.length += time_s * speed;
  top_ = speed > top_ ? speed : top_;
  last_ = speed;
}

void RestMeter::rest() {
  lost_s_ += ramp_.loss_s(top_);
  ramp_ = {};
  top_ = last_ = 0;
  sets_off_ = true;
}

}  // namespace meridian::simulate
