// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian {

/// States of a drive. Source: CiA 402-2 (IEC 61800-7-201), finite state automaton.
enum class DriveState : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStop,
  kFaultReaction,
  kFault
};

/// What a statusword says. Source: CiA 402-2, object 6041h, bits 0 to 3, 5 and 6.
/// Proof: tests/unit/cycle/drive_state_test.cpp.
[[nodiscard]] constexpr DriveState drive_state(std::uint16_t statusword) noexcept {
  switch (statusword & 0x4FU) {
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0F:
      return DriveState::kFaultReaction;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (statusword & 0x6FU) {
    case 0x21:
      return DriveState::kReadyToSwitchOn;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStop;
    default:
      return DriveState::kNotReady;
  }
}

/// As the standard calls it.
[[nodiscard]] constexpr const char* name_of(DriveState state) noexcept {
  switch (state) {
    case DriveState::kNotReady:
      return "not ready";
    case DriveState::kSwitchOnDisabled:
      return "switch on disabled";
    case DriveState::kReadyToSwitchOn:
      return "ready to switch on";
    case DriveState::kSwitchedOn:
      return "switched on";
    case DriveState::kOperationEnabled:
      return "operation enabled";
    case DriveState::kQuickStop:
      return "quick stop";
    case DriveState::kFaultReaction:
      return "fault reaction";
    case DriveState::kFault:
      return "fault";
  }
  return "unknown";
}

}  // namespace meridian
