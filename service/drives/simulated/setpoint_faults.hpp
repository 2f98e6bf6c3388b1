// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

#include "service/transport/convert/messages.hpp"

namespace meridian::drives {

/// What is wrong with the wire on which setpoints come: it loses them for a while, or delays them.
/// Proof: tests/unit/simulated_drives/drive_group_test.cpp.
class SetpointFaults {
 public:
  void deafen(double periods) noexcept { deaf_periods_ = static_cast<std::int64_t>(periods); }
  void delay(double periods) noexcept { delay_periods_ = static_cast<std::int64_t>(periods); }

  /// Whether a setpoint that comes now gets through at once; one that is delayed is kept.
  [[nodiscard]] bool lets_pass(const dds::SetpointSample& setpoint) {
    if (deaf_periods_ > 0) return false;
    if (delay_periods_ == 0) return true;
    in_flight_.push_back({now_ + delay_periods_, setpoint});
    return false;
  }
  /// Periods go by.
  void work(int periods) noexcept {
    now_ += periods;
    deaf_periods_ = deaf_periods_ > periods ? deaf_periods_ - periods : 0;
  }
  /// A delayed setpoint that arrives now; call until there is none.
  [[nodiscard]] bool arrives(dds::SetpointSample& setpoint) {
    if (in_flight_.empty() || in_flight_.front().due > now_) return false;
    setpoint = in_flight_.front().setpoint;
    in_flight_.pop_front();
    return true;
  }

 private:
  struct InFlight {
    std::int64_t due;
    dds::SetpointSample setpoint;
  };
  std::int64_t now_ = 0, deaf_periods_ = 0, delay_periods_ = 0;
  std::deque<InFlight> in_flight_;
};

}  // namespace meridian::drives
