// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian {

/// What the machine is doing (docs/operating.md has the table verb × state).
enum class State : std::uint8_t {
  kOff,
  kEnabling,
  kReady,
  kLoaded,
  kApproaching,
  kRunning,
  kHolding,
  kHeld,
  kStarving,
  kStarved,
  kAborting,
  kDisabling,
  kFaultStop,
  kFault,
  kJogging,
  kHoming,
  kStepping
};
inline constexpr int kStateCount = 17;

/// What an operator asks for.
enum class Verb : std::uint8_t {
  kEnable,
  kDisable,
  kStart,
  kHold,
  kResume,
  kAbort,
  kReset,
  kFeedOverride,   ///< argument: factor, 0 to MachineModel::max_feed_override
  kRapidOverride,  ///< argument: factor, 0 to 1
  kJog,            ///< argument: the joint that is jogged first; a ToolAxis + kMaxJoints
  kHome,           ///< argument: mask of the joints, 0: all
  kSingleBlock,    ///< argument: 1 on, 0 off
  kOptionalStop,   ///< argument: 1 on, 0 off
  kDryRun,         ///< argument: 1 on, 0 off
  kFrame,          ///< argument: number of the work frame that is in force from here on
  kTool,           ///< another tool table is in force from here on
  kLimits,         ///< other soft limits are in force from here on
};
inline constexpr int kVerbCount = 17;

}  // namespace meridian
