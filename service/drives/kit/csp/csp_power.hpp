// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/cycle/drive_state.hpp"

namespace meridian::drive {

/// The states of a drive behind a fieldbus, walked from outside: the controlword that leads to
/// where the axis is wanted. A drive that leaves operation enabled by itself has dropped: it is not
/// led back until it was wanted off. RT. Source: CiA 402-2, commands of the controlword.
/// Proof: tests/unit/drive_kit/csp_power_test.cpp.
class CspPower {
 public:
  /// What 6041h says.
  void see(std::uint16_t statusword) noexcept {
    state_ = drive_state(statusword);
    if (state_ == DriveState::kOperationEnabled) {
      if (wish_ == Wish::kOn) wish_ = Wish::kFulfilled;
    } else if (wish_ == Wish::kFulfilled && !is_fault()) {
      wish_ = Wish::kDropped;
    }
  }

  /// Object 6040h for this period, without the bits of a mode.
  [[nodiscard]] std::uint16_t controlword(bool is_wanted, bool is_reset) noexcept {
    if (!is_wanted) wish_ = Wish::kOff;
    if (is_wanted && wish_ == Wish::kOff) wish_ = Wish::kOn;
    reset_periods_ = state_ == DriveState::kFault && is_reset ? reset_periods_ + 1 : 0;
    switch (state_) {
      case DriveState::kFault:
        // An edge, and another one where the drive did not reset by the first.
        return (reset_periods_ / kResetHalf) % 2 == 1 ? kFaultReset : kDisableVoltage;
      case DriveState::kNotReady:
      case DriveState::kFaultReaction:
      case DriveState::kQuickStop:
        return kDisableVoltage;
      case DriveState::kSwitchOnDisabled:
        return kShutdown;
      case DriveState::kReadyToSwitchOn:
        return may_go_on() ? kSwitchOn : kShutdown;
      case DriveState::kSwitchedOn:
      case DriveState::kOperationEnabled:
        return may_go_on() ? kEnableOperation : kShutdown;
    }
    return kDisableVoltage;
  }

  [[nodiscard]] bool is_enabled() const noexcept { return state_ == DriveState::kOperationEnabled; }
  [[nodiscard]] bool is_fault() const noexcept {
    return state_ == DriveState::kFault || state_ == DriveState::kFaultReaction;
  }
  [[nodiscard]] bool has_dropped() const noexcept { return wish_ == Wish::kDropped; }

 private:
  enum class Wish : std::uint8_t {
    kOff,
    kOn,         ///< wanted on, and not enabled yet
    kFulfilled,  ///< it was enabled since
    kDropped     ///< it left that by itself
  };
  [[nodiscard]] bool may_go_on() const noexcept {
    return wish_ == Wish::kOn || wish_ == Wish::kFulfilled;
  }

  static constexpr std::uint16_t kDisableVoltage = 0x00, kShutdown = 0x06, kSwitchOn = 0x07,
                                 kEnableOperation = 0x0F, kFaultReset = 0x80;
  static constexpr unsigned kResetHalf = 16;  ///< periods of low, then of high

  DriveState state_ = DriveState::kNotReady;
  Wish wish_ = Wish::kOff;
  unsigned reset_periods_ = 0;
};

}  // namespace meridian::drive
