// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "meridian/cycle/drive_state.hpp"
#include "service/transport/convert/messages.hpp"

/// CiA 402 as a controller sees it: what a drive says in homing mode, which words it is sent next.
/// Proof: tests/unit/daemon/drive_words_test.cpp.
namespace meridian::interpolator {

/// What a statusword says in homing mode. Source: CiA 402-2, bits 10, 12 and 13 of object 6041h.
struct HomingWord {
  bool is_still = false;     ///< over, interrupted or not begun
  bool is_attained = false;  ///< the reference was found, and the drive stands
  bool has_failed = false;
};
[[nodiscard]] constexpr HomingWord homing_word(std::uint16_t statusword) noexcept {
  const bool is_still = (statusword & 0x0400U) != 0, has_failed = (statusword & 0x2000U) != 0;
  return {is_still, is_still && (statusword & 0x1000U) != 0 && !has_failed, has_failed};
}

namespace controlword {
inline constexpr std::uint16_t kDisableVoltage = 0x00;
inline constexpr std::uint16_t kShutdown = 0x06;
inline constexpr std::uint16_t kSwitchOn = 0x07;
inline constexpr std::uint16_t kEnableOperation = 0x0F;
inline constexpr std::uint16_t kFaultReset = 0x80;
inline constexpr std::uint16_t kStartHoming = 0x10;  ///< in homing mode, beside kEnableOperation
}  // namespace controlword

/// Returns the controlword that brings a drive one step nearer to operation enabled, or keeps it
/// there; with `is_wanted` false, to ready to switch on. A fault is left alone: it is reset by the
/// operator's word only.
[[nodiscard]] constexpr std::uint16_t next_controlword(DriveState state, bool is_wanted) noexcept {
  switch (state) {
    case DriveState::kReadyToSwitchOn:
      return is_wanted ? controlword::kSwitchOn : controlword::kShutdown;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return is_wanted ? controlword::kEnableOperation : controlword::kShutdown;
    case DriveState::kQuickStop:
      return is_wanted ? controlword::kEnableOperation : controlword::kDisableVoltage;
    case DriveState::kSwitchOnDisabled:
      return controlword::kShutdown;
    case DriveState::kNotReady:
    case DriveState::kFaultReaction:
    case DriveState::kFault:
      return controlword::kDisableVoltage;
  }
  return controlword::kDisableVoltage;
}

/// What a drive is to do in operation.
enum class DriveWork : std::uint8_t {
  kFollow,  ///< setpoints, in cyclic position mode
  kHome,    ///< nothing, in homing mode
  kSearch   ///< its reference, in homing mode
};

/// The work that masks of joints ask of `drive`; only one that is to home can be to search.
[[nodiscard]] constexpr DriveWork drive_work(std::uint32_t homing_mask, std::uint32_t search_mask,
                                             std::size_t drive) noexcept {
  if ((homing_mask >> drive & 1U) == 0) return DriveWork::kFollow;
  return (search_mask >> drive & 1U) != 0 ? DriveWork::kSearch : DriveWork::kHome;
}

/// What the machine asks of one drive.
struct DriveTask {
  bool is_enabled = false;  ///< to be in operation
  DriveWork work = DriveWork::kFollow;
  bool is_reset = false;  ///< of a fault: the operator said so
};

/// Objects 6040h and 6060h.
struct DriveOrder {
  std::uint16_t controlword = controlword::kDisableVoltage;
  std::uint8_t mode = dds::kCyclicPositionMode;
};

/// Returns what a drive that says `statusword` is sent next; one that is not heard counts as
/// switched off.
[[nodiscard]] constexpr DriveOrder next_order(bool is_heard, std::uint16_t statusword,
                                              const DriveTask& task) noexcept {
  const DriveState state = is_heard ? drive_state(statusword) : DriveState::kSwitchOnDisabled;
  DriveOrder order{next_controlword(state, task.is_enabled)};
  if (state == DriveState::kFault && task.is_reset) order.controlword = controlword::kFaultReset;
  if (task.work != DriveWork::kFollow) order.mode = dds::kHomingMode;
  if (state == DriveState::kOperationEnabled && task.work == DriveWork::kSearch) {
    order.controlword |= controlword::kStartHoming;
  }
  return order;
}

}  // namespace meridian::interpolator
