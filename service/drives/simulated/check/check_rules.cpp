// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/check/check_rules.hpp"

#include <array>
#include <cstddef>

namespace meridian::drives {
namespace {

constexpr const char* kReport = "docs/topics.md, What a report must say";
constexpr const char* kSource = "docs/topics.md, Who reports a drive";
constexpr const char* kMaster = "docs/topics.md, Drives obey one master";
constexpr const char* kSent = "docs/topics.md, Drives check what they are sent";
constexpr const char* kDry = "docs/topics.md, A setpoint is followed by its flags";
constexpr const char* kStates = "docs/drive-library.md, CiA 402";
constexpr const char* kLost = "docs/drive-library.md, Setpoints";
constexpr const char* kEmergency = "docs/drive-library.md, Emergency input";
constexpr const char* kHomes = "docs/drive-library.md, Homing";

constexpr std::array kRules{
    RuleText{Rule::kAllDrives, "all-drives", "every joint of the machine is reported", kSource},
    RuleText{Rule::kKnownJoints, "known-joints", "joints that the machine lacks are not reported",
             kSource},
    RuleText{Rule::kInTime, "in-time", "reports come all the time", kReport},
    RuleText{Rule::kSampleCounts, "sample-counts", "each report has a greater sample", kReport},
    RuleText{Rule::kNumbers, "numbers", "positions are numbers", kReport},
    RuleText{Rule::kNoJump, "no-jump", "0Fh enables no drive that is switched off", kStates},
    RuleText{Rule::kWalksUp, "walks-up", "06h, 07h, 0Fh lead to operation enabled", kStates},
    RuleText{Rule::kNamesMaster, "names-master", "reports have the service_id that is obeyed",
             kMaster},
    RuleText{Rule::kStandsWhenEnabled, "stands-when-enabled", "enabling moves nothing", kStates},
    RuleText{Rule::kCycleSeen, "cycle-seen", "cycle_seen is the newest setpoint's cycle", kReport},
    RuleText{Rule::kNotEnabledSetpoint, "not-enabled",
             "a setpoint without the flag 1 is not followed", kDry},
    RuleText{Rule::kFollows, "follows", "drives follow inside their following error", kSent},
    RuleText{Rule::kOrder, "order", "a setpoint that is not newer than the last is dropped", kSent},
    RuleText{Rule::kDoubled, "doubled", "a setpoint that comes twice, or again and again, is one",
             kSent},
    RuleText{Rule::kChecksum, "checksum", "a setpoint with a wrong checksum is dropped", kSent},
    RuleText{Rule::kLate, "late", "a setpoint that the wire held back is dropped", kSent},
    RuleText{Rule::kDryRun, "dry-run", "a setpoint of a dry run is passed over", kDry},
    RuleText{Rule::kForeignSetpoint, "foreign-setpoint", "setpoints of others are dropped",
             kMaster},
    RuleText{Rule::kForeignCommand, "foreign-command", "drive commands of others are dropped",
             kMaster},
    RuleText{Rule::kBridge, "bridge", "lost setpoints are bridged by the sent velocity", kLost},
    RuleText{Rule::kWatchdog, "watchdog", "setpoints that stay away end in fault 8700h", kLost},
    RuleText{Rule::kRamp, "ramp", "after the bridge drives ramp down, by fault_acceleration",
             kLost},
    RuleText{Rule::kKilled, "killed",
             "a service that is killed in motion leaves drives that come to rest in time, no jump",
             kLost},
    RuleText{Rule::kFaultStays, "fault-stays", "06h, 07h, 0Fh do not leave a fault", kStates},
    RuleText{Rule::kFaultReset, "fault-reset", "the rising edge of bit 7 resets a fault", kStates},
    RuleText{Rule::kResetEdge, "reset-edge", "bit 7 that stays set resets nothing", kStates},
    RuleText{Rule::kNoNumber, "no-number", "a setpoint that is no number is fault FF01h", kSent},
    RuleText{Rule::kTravel, "travel", "a setpoint out of travel is fault FF02h", kSent},
    RuleText{Rule::kVelocity, "velocity", "a velocity beyond the limit is fault FF03h", kSent},
    RuleText{Rule::kStep, "step", "a step beyond the velocity limit is fault FF04h", kSent},
    RuleText{Rule::kBegin, "begin", "a first setpoint apart from the drive is fault FF05h", kSent},
    RuleText{Rule::kQuickStop, "quick-stop", "02h leads from operation to quick stop", kStates},
    RuleText{Rule::kDisableVoltage, "disable-voltage", "00h leads to switch on disabled", kStates},
    RuleText{Rule::kShutdown, "shutdown", "06h leads from operation to ready", kStates},
    RuleText{Rule::kModeDisplay, "mode-display", "mode_display says the mode that was asked for",
             kHomes},
    RuleText{Rule::kHomingCycle, "homing-cycle", "cycle_seen goes on in homing mode", kReport},
    RuleText{Rule::kReferenceLost, "reference-lost",
             "a drive that searches has no reference until it has found one", kHomes},
    RuleText{Rule::kReferenceFound, "reference-found",
             "a search ends with a reference, or says that there is none", kHomes},
    RuleText{Rule::kEmergencyStop, "emergency-stop",
             "an open emergency stop is reported for as long as it is open", kEmergency},
    RuleText{Rule::kKeepsMaster, "keeps-master",
             "a service that is there keeps drives that are off", kMaster},
    RuleText{Rule::kGoneInMotion, "gone-in-motion",
             "a service that is gone while drives are on ends in fault 8700h, by bridge and ramp",
             kLost},
    RuleText{Rule::kRestart, "restart",
             "a service that starts again is obeyed when the drives are off, not before", kMaster},
    RuleText{Rule::kFreesMaster, "frees-master", "drives that are off are free when it is gone",
             kMaster},
    RuleText{Rule::kNextMaster, "next-master", "the next service is obeyed", kMaster},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    if (kRules[i].rule != static_cast<Rule>(i)) return false;
  }
  return true;
}
static_assert(are_in_order() && kRules.size() == static_cast<std::size_t>(Rule::kNextMaster) + 1);

}  // namespace

std::span<const RuleText> check_rules() noexcept { return kRules; }

const RuleText& text_of(Rule rule) noexcept { return kRules[static_cast<std::size_t>(rule)]; }

}  // namespace meridian::drives
