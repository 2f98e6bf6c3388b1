// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace meridian::drives {

/// What a program of drives has to keep; `meridian drives --check` names the ones that it breaks.
enum class Rule : std::uint8_t {
  kAllDrives,
  kKnownJoints,
  kInTime,
  kSampleCounts,
  kNumbers,
  kNoJump,
  kWalksUp,
  kNamesMaster,
  kStandsWhenEnabled,
  kCycleSeen,
  kNotEnabledSetpoint,
  kFollows,
  kOrder,
  kDoubled,
  kChecksum,
  kLate,
  kDryRun,
  kForeignSetpoint,
  kForeignCommand,
  kBridge,
  kWatchdog,
  kRamp,
  kKilled,
  kFaultStays,
  kFaultReset,
  kResetEdge,
  kNoNumber,
  kTravel,
  kVelocity,
  kStep,
  kBegin,
  kQuickStop,
  kDisableVoltage,
  kShutdown,
  kModeDisplay,
  kHomingCycle,
  kReferenceLost,
  kReferenceFound,
  kEmergencyStop,
  kKeepsMaster,
  kGoneInMotion,
  kRestart,
  kFreesMaster,
  kNextMaster
};

/// A rule as people read it.
struct RuleText {
  Rule rule;
  const char* name;  ///< one word, for lists
  const char* says;  ///< the rule
  const char* page;  ///< of the docs that states it
};
[[nodiscard]] std::span<const RuleText> check_rules() noexcept;
[[nodiscard]] const RuleText& text_of(Rule rule) noexcept;

/// A rule that was broken, and what was seen.
struct Finding {
  Rule rule;
  std::string seen;
};

}  // namespace meridian::drives
