// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/cycle/drive_state.hpp"

namespace meridian::drive {

/// Object 603Fh.
enum ErrorCode : std::uint16_t {
  kErrorNone = 0,
  kErrorDevice = 0x5000,            ///< injected: device hardware
  kErrorFollowing = 0x8611,         ///< following error beyond the joint's limit
  kErrorSetpointsStopped = 0x8700,  ///< synchronous controller: setpoints stayed away
  // Manufacturer specific: a setpoint of the master broke the drive's own limits.
  kErrorSetpointNoNumber = 0xFF01,  ///< position or velocity is no number, or absurd
  kErrorSetpointTravel = 0xFF02,    ///< outside of travel
  kErrorSetpointVelocity = 0xFF03,  ///< its velocity is beyond the limit
  kErrorSetpointStep = 0xFF04,      ///< farther from the last one than the limit reaches
  kErrorSetpointBegin = 0xFF05,     ///< the first one to follow is not where the drive stands
  kErrorNoPosition = 0xFF06         ///< the position that the hardware reads is no number
};

/// Returns the state that `controlword` (object 6040h) leads to from `state`. `before` is the
/// controlword before it: a fault is reset by the rising edge of bit 7 alone. Faults themselves and
/// the end of a fault reaction are the drive's, not the controlword's.
/// Proof: tests/unit/drive_kit/cia402_test.cpp.
[[nodiscard]] constexpr DriveState next_state(DriveState state, std::uint16_t controlword,
                                              std::uint16_t before) noexcept {
  if (state == DriveState::kFaultReaction) return state;
  if (state == DriveState::kFault) {
    const bool is_reset = (controlword & ~before & 0x80) != 0;
    return is_reset ? DriveState::kSwitchOnDisabled : state;
  }
  if ((controlword & 0x02) == 0) return DriveState::kSwitchOnDisabled;  // disable voltage
  if ((controlword & 0x04) == 0) {                                      // quick stop
    const bool is_enabled =
        state == DriveState::kOperationEnabled || state == DriveState::kQuickStop;
    return is_enabled ? DriveState::kQuickStop : DriveState::kSwitchOnDisabled;
  }
  const bool is_switch_on = (controlword & 0x01) != 0, is_enable = (controlword & 0x09) == 0x09;
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return is_switch_on ? state : DriveState::kReadyToSwitchOn;
    case DriveState::kReadyToSwitchOn:
      return is_switch_on ? DriveState::kSwitchedOn : state;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      if (is_enable) return DriveState::kOperationEnabled;
      return is_switch_on ? DriveState::kSwitchedOn : DriveState::kReadyToSwitchOn;
    default:
      return state;
  }
}

/// Returns bits 0 to 3, 5, 6 of object 6041h for `state`, with voltage enabled (4) and remote (9).
[[nodiscard]] constexpr std::uint16_t statusword(DriveState state) noexcept {
  constexpr std::uint16_t kAlways = 0x210;
  switch (state) {
    case DriveState::kNotReady:
      return kAlways;
    case DriveState::kSwitchOnDisabled:
      return kAlways | 0x40;
    case DriveState::kReadyToSwitchOn:
      return kAlways | 0x21;
    case DriveState::kSwitchedOn:
      return kAlways | 0x23;
    case DriveState::kOperationEnabled:
      return kAlways | 0x27;
    case DriveState::kQuickStop:
      return kAlways | 0x07;
    case DriveState::kFaultReaction:
      return kAlways | 0x0F;
    case DriveState::kFault:
      return kAlways | 0x08;
  }
  return 0;
}

inline constexpr std::uint16_t kStatusFollows = 0x1000;  ///< CSP: follows the command value
inline constexpr std::uint16_t kStatusFollowingError = 0x2000;

}  // namespace meridian::drive
