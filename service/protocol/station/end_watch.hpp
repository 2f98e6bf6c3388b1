// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

/// Sees that a program ran and is over: from the status, and from setpoints for one so short that
/// no status reports it. What a hand moves, or drives that home, is no program.
/// Proof: tests/unit/protocol/end_watch_test.cpp.
class EndWatch {
 public:
  void see(const Setpoint& setpoint) noexcept {
    if ((setpoint.flags & kSetpointMoving) != 0) moved_ = std::max(moved_, setpoint.cycle);
  }
  void see(const dds::Status& status) noexcept {
    const bool is_idle = status.state == State::kReady || status.state == State::kOff ||
                         status.state == State::kFault;
    const bool is_by_hand = status.state == State::kJogging || status.state == State::kHoming;
    has_run_ = has_run_ || status.state == State::kRunning;
    if (is_by_hand || was_by_hand_) by_hand_ = status.cycle;
    was_by_hand_ = is_by_hand || (was_by_hand_ && !is_idle);
    const bool has_moved = moved_ > by_hand_ && status.cycle > moved_;
    is_over_ = (has_run_ || has_moved) && is_idle;
  }
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

 private:
  std::uint64_t moved_ = 0;    ///< newest cycle in motion
  std::uint64_t by_hand_ = 0;  ///< up to this cycle motion was a hand's, or a homing's
  bool was_by_hand_ = false, has_run_ = false, is_over_ = false;
};

}  // namespace meridian::stream
