// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// How a stop leads to rest, and the one function that changes it. RT: cycle.
namespace meridian {

/// Which of the joints' limits a stop may use.
enum class StopKind : std::uint8_t { kHold, kFault };

enum class StopMode : std::uint8_t {
  kNone,              ///< nothing stops
  kOnPath,            ///< on the path, by a law of its own
  kHoldAlongPlan,     ///< along the plan, its rate going down to zero, until a law may begin
  kFaultAlongPlan,    ///< the same in a FaultStop
  kOffPath,           ///< every joint on its own line, from where it was commanded
  kOffPathFromDrives  ///< the same, from where drives went on to by themselves: in travel or not
};
inline constexpr int kStopModeCount = 6;

enum class StopEvent : std::uint8_t {
  kLaidOut,       ///< there is a stop margin for a law on the path
  kHold,          ///< a hold begins without one
  kFault,         ///< a FaultStop begins without one
  kPlanRests,     ///< the plan rests, or its rate does: no law was needed
  kPathLost,      ///< the path gives no setpoint that may be sent
  kDrivesWentOn,  ///< more periods were lost than drives bridge, and no path leads on from there
  kRested         ///< the joints rest
};
inline constexpr int kStopEventCount = 7;

[[nodiscard]] constexpr bool is_along_plan(StopMode mode) noexcept {
  return mode == StopMode::kHoldAlongPlan || mode == StopMode::kFaultAlongPlan;
}
[[nodiscard]] constexpr bool is_off_path(StopMode mode) noexcept {
  return mode >= StopMode::kOffPath;
}

/// The mode behind `event`. Only a stop along the plan can come to rest with it; every other event
/// says by itself how the joints go on. Proof: tests/unit/cycle/stop_mode_test.cpp.
[[nodiscard]] constexpr StopMode mode_after(StopMode mode, StopEvent event) noexcept {
  switch (event) {
    case StopEvent::kLaidOut:
      return StopMode::kOnPath;
    case StopEvent::kHold:
      return StopMode::kHoldAlongPlan;
    case StopEvent::kFault:
      return StopMode::kFaultAlongPlan;
    case StopEvent::kPlanRests:
      return is_along_plan(mode) ? StopMode::kOffPath : mode;
    case StopEvent::kPathLost:
      return StopMode::kOffPath;
    case StopEvent::kDrivesWentOn:
      return StopMode::kOffPathFromDrives;
    case StopEvent::kRested:
      return StopMode::kNone;
  }
  return mode;
}

}  // namespace meridian
