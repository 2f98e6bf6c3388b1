// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/check/drive_check.hpp"

#include <cmath>
#include <initializer_list>
#include <utility>

#include "meridian/kinematics/limited.hpp"
#include "service/drives/kit/csp/homing_run.hpp"

namespace meridian::drives {

DriveCheck::DriveCheck(const MachineModel& model, CheckedDrives& drives,
                       std::function<void(const std::string&)> report)
    : player_(model, drives), report_(std::move(report)) {
  for (int i = 0; i < model.joint_count; ++i) {
    if (drive_spec(model, i).is_rotary) continue;
    mover_ = static_cast<std::size_t>(i);
    break;
  }
  limit_ = drive_spec(model, static_cast<int>(mover_)).limits.velocity;
}

/// Findings of a step in which this program overslept are forgotten, and the step is done again.
void DriveCheck::step(const char* what, const std::function<void()>& body) {
  constexpr int kTries = 6;
  if (report_) report_(what);
  for (int n = 0; n < kTries; ++n) {
    const std::vector<Finding> before = player_.findings;
    player_.is_disturbed = false;
    body();
    if (!player_.is_disturbed) return;
    player_.findings = before;
  }
  result_.unproven.emplace_back(what);
}

CheckReport DriveCheck::run(Operator operator_is) {
  player_.saying = Saying::kNothing;
  result_.has_drives =
      player_.until([this] { return player_.is_any_reported(); }, 2 * CheckPlayer::kPatience);
  if (!result_.has_drives) return result_;
  player_.saying = Saying::kAll;
  player_.ticks(100);
  const std::uint32_t all = (1U << static_cast<unsigned>(player_.count())) - 1;
  if ((player_.newest.joint_mask & all) != all) {
    player_.find(Rule::kAllDrives, "joint_mask " + std::to_string(player_.newest.joint_mask));
  }
  const JointLimits& limits = drive_spec(player_.model(), static_cast<int>(mover_)).limits;
  const double middle = 0.5 * (limits.travel_min + limits.travel_max);
  direction_ = player_.newest.position[mover_] <= middle ? 1 : -1;
  step("states", [this] { check_states(); });
  step("enabling", [this] { check_enabling(); });
  step("following", [this] { check_following(); });
  check_all_dropped();
  step("doubled setpoints", [this] { check_doubled(); });
  step("others' commands", [this] { check_foreign_commands(); });
  step("bridge", [this] { check_bridge(); });
  step("setpoints that stay away", [this] { check_watchdog(); });
  step("a service that is killed in motion", [this] { check_killed(); });
  step("reset of faults", [this] { check_reset(); });
  check_all_refused();
  step("begin", [this] { check_begin(); });
  step("homing", [this] { check_homing(); });
  if (operator_is == Operator::kThere) check_emergency_stop();
  step("two services", [this] { check_masters(); });
  if (report_) report_("a service that starts again in motion");
  check_restart();
  if (report_) report_("the next service");
  check_next_master();  // once: the service is gone, and overslept periods change nothing
  result_.findings = player_.findings;
  return result_;
}

bool DriveCheck::rest() {
  constexpr int kTries = 4;
  player_.saying = Saying::kAll;
  player_.flags = 0;
  player_.modes.fill(dds::kCyclicPositionMode);
  player_.stand();
  const auto is_off = [this] { return player_.are_all(DriveState::kSwitchOnDisabled); };
  for (int n = 0; n < kTries; ++n) {
    player_.say_word(0x00);
    player_.ticks(60);
    // The edge of a reset is lost on a drive that still ramps down.
    (void)player_.until([this] { return !player_.is_any(DriveState::kFaultReaction); },
                        CheckPlayer::kPatience);
    player_.say_word(0x80);
    if (!player_.until(is_off, CheckPlayer::kPatience / kTries)) continue;
    player_.say_word(0x00);
    player_.ticks(5);
    return true;
  }
  const bool is_fault =
      player_.is_any(DriveState::kFault) || player_.is_any(DriveState::kFaultReaction);
  player_.find(
      is_fault ? Rule::kFaultReset : Rule::kDisableVoltage,
      is_fault ? "80h leaves a drive in fault" : "00h does not lead to switch on disabled");
  return false;
}

bool DriveCheck::walk_up() {
  if (!rest()) return false;
  const std::pair<std::uint16_t, DriveState> steps[] = {{0x06, DriveState::kReadyToSwitchOn},
                                                        {0x07, DriveState::kSwitchedOn},
                                                        {0x0F, DriveState::kOperationEnabled}};
  for (const auto& [word, state] : steps) {
    player_.say_word(word);
    if (player_.until([this, to = state] { return player_.are_all(to); }, CheckPlayer::kPatience))
      continue;
    player_.find(Rule::kWalksUp, in_hex(word) + " does not lead to " + name_of(state));
    return false;
  }
  player_.ticks(20);
  player_.stand();
  player_.flags = kSetpointEnabled;
  player_.ticks(60);
  return true;
}

void DriveCheck::check_states() {
  if (!rest()) return;
  if (player_.newest.service_id != CheckPlayer::kServiceId) {
    player_.find(Rule::kNamesMaster, "service_id " + std::to_string(player_.newest.service_id));
  }
  player_.say_word(0x0F);
  player_.ticks(60);
  if (!player_.are_all(DriveState::kSwitchOnDisabled)) {
    player_.find(Rule::kNoJump, "0Fh led out of switch on disabled");
  }
  const std::pair<Rule, std::pair<std::uint16_t, DriveState>> commands[] = {
      {Rule::kShutdown, {0x06, DriveState::kReadyToSwitchOn}},
      {Rule::kDisableVoltage, {0x00, DriveState::kSwitchOnDisabled}},
      {Rule::kQuickStop, {0x02, DriveState::kQuickStop}}};
  for (const auto& [rule, command] : commands) {
    if (!walk_up()) return;
    player_.say_word(command.first);
    const DriveState to = command.second;
    if (player_.until([this, to] { return player_.are_all(to); }, 500)) continue;
    player_.find(rule, in_hex(command.first) + " leads to " + name_of(player_.state(0)));
  }
}

void DriveCheck::check_enabling() {
  if (!rest()) return;
  const JointVector stood = player_.newest.position;
  if (!walk_up()) return;
  for (int i = 0; i < player_.count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const JointSpec& spec = drive_spec(player_.model(), i);
    const double distance = std::abs(player_.newest.position[at] - stood[at]);
    if (distance > (spec.is_rotary ? 1e-3 : 0.1)) {
      player_.find(Rule::kStandsWhenEnabled,
                   "drive " + spec.name + " moved by " + std::to_string(distance));
    }
  }
  if (!player_.is_heard()) {
    player_.find(Rule::kCycleSeen, "cycle_seen " + std::to_string(player_.newest.cycle_seen));
  }
}

void DriveCheck::check_foreign_commands() {
  if (!walk_up()) return;
  for (const std::uint64_t id : {CheckPlayer::kServiceId, CheckPlayer::kOtherId}) {
    for (const std::uint16_t word : {std::uint16_t{0x06}, std::uint16_t{0x00}}) {
      for (int n = 0; n < 10; ++n) {
        player_.tick([&](CheckedDrives&) { player_.command_all(Speaker::kOther, id, word); });
        if (player_.are_all(DriveState::kOperationEnabled)) continue;
        player_.find(Rule::kForeignCommand, "another one's " + in_hex(word) + " was obeyed");
      }
    }
  }
}

void DriveCheck::check_reset() {
  if (!walk_up()) return;
  player_.saying = Saying::kNoSetpoints;
  const auto is_fault = [this] { return player_.are_all(DriveState::kFault); };
  if (!player_.until(is_fault, CheckPlayer::kPatience)) return;
  player_.saying = Saying::kAll;
  player_.flags = 0;
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
    player_.say_word(word);
    player_.ticks(30);
  }
  if (!is_fault()) return player_.find(Rule::kFaultStays, "0Fh left the fault");
  player_.say_word(0x80);
  if (!player_.until([this] { return player_.are_all(DriveState::kSwitchOnDisabled); },
                     CheckPlayer::kPatience)) {
    return player_.find(Rule::kFaultReset,
                        "80h leaves it in " + std::string(name_of(player_.state(0))));
  }
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x86, 0x87, 0x8F}) {
    player_.say_word(word);
    player_.ticks(60);
  }
  if (!player_.are_all(DriveState::kOperationEnabled)) return;  // slower than that: not to be seen
  player_.saying = Saying::kNoSetpoints;
  if (!player_.until(is_fault, 500))
    player_.find(Rule::kResetEdge, "bit 7 that stays set keeps it out of fault");
  player_.ticks(120);
  if (!is_fault()) player_.find(Rule::kResetEdge, "bit 7 that stays set resets a new fault");
  player_.saying = Saying::kAll;
}

void DriveCheck::check_homing() {
  if (!walk_up()) return;
  player_.modes[mover_] = dds::kHomingMode;
  const auto has_mode = [this] { return player_.newest.mode_display[mover_] == dds::kHomingMode; };
  if (!player_.until(has_mode, 1000)) player_.find(Rule::kModeDisplay, "it stays at another mode");
  player_.ticks(80);
  if (!player_.is_heard()) player_.find(Rule::kHomingCycle, "cycle_seen stands still");
  player_.words[mover_] = 0x1F;
  player_.ticks(30);
  const auto bits = [this] { return player_.newest.statusword[mover_] & 0x3400; };
  const auto is_referenced = [this] {
    return (player_.newest.referenced_mask >> mover_ & 1U) != 0;
  };
  const auto is_over = [&] {
    if (bits() == 0 && is_referenced()) {
      player_.find(Rule::kReferenceLost, "the drive searches and has a reference");
    }
    return (bits() & drive::kStatusTargetReached) != 0;
  };
  const bool ends = player_.until(is_over, 60'000);
  player_.ticks(10);
  const bool is_attained = (bits() & drive::kStatusHomingAttained) != 0;
  const bool has_failed = (bits() & drive::kStatusHomingError) != 0;
  if (!ends || is_attained == has_failed || is_attained != is_referenced()) {
    player_.find(Rule::kReferenceFound, !ends         ? "it searches for ever"
                                        : is_attained ? "it is attained without a reference"
                                        : has_failed  ? "it failed, and has a reference"
                                                      : "neither attained nor failed");
  }
  player_.stand();
  player_.words[mover_] = 0x0F;
  player_.modes[mover_] = dds::kCyclicPositionMode;
  player_.ticks(60);
}

void DriveCheck::check_masters() {
  if (!rest()) return;
  player_.say_word(0x06);
  player_.ticks(60);
  player_.ticks(20, [this](CheckedDrives&) {
    player_.command_all(Speaker::kOther, CheckPlayer::kOtherId, 0x07);
  });
  const bool is_kept =
      player_.newest.service_id == CheckPlayer::kServiceId || player_.newest.service_id == 0;
  if (!is_kept || !player_.are_all(DriveState::kReadyToSwitchOn)) {
    player_.find(Rule::kKeepsMaster, "another one took the drives");
  }
}

/// The operator opens the stop of drives that are on and stand, and closes it again.
void DriveCheck::check_emergency_stop() {
  constexpr int kMinute = 60'000, kHeld = 200;
  if (report_) report_("emergency stop");
  if (!walk_up()) return;
  const auto is_open = [this] { return player_.newest.is_emergency_stop; };
  if (is_open()) return player_.find(Rule::kEmergencyStop, "it is reported before it is opened");
  player_.ask(Wish::kOpenEmergencyStop);
  if (!player_.until(is_open, kMinute)) {
    return player_.find(Rule::kEmergencyStop, "it was opened, and no report says so");
  }
  for (int n = 0; n < kHeld; ++n) {
    player_.tick();
    if (!is_open()) player_.find(Rule::kEmergencyStop, "it is open, and a report says it is not");
  }
  player_.say_word(0x00);
  player_.ask(Wish::kCloseEmergencyStop);
  if (!player_.until([&] { return !is_open(); }, kMinute)) {
    player_.find(Rule::kEmergencyStop, "it was closed, and no report says so");
  }
}

void DriveCheck::check_next_master() {
  player_.say_word(0x06);
  player_.ticks(60);
  player_.end_service();
  if (!player_.until([this] { return player_.newest.service_id == 0; }, CheckPlayer::kPatience)) {
    player_.find(Rule::kFreesMaster, "service_id " + std::to_string(player_.newest.service_id));
  }
  for (int n = 0; n < 200 && player_.newest.service_id != CheckPlayer::kOtherId; ++n) {
    player_.tick([this](CheckedDrives&) {
      player_.command_all(Speaker::kOther, CheckPlayer::kOtherId, 0x06);
    });
    player_.ticks(4);
  }
  if (player_.newest.service_id != CheckPlayer::kOtherId) {
    player_.find(Rule::kNextMaster, "service_id " + std::to_string(player_.newest.service_id));
  }
}

}  // namespace meridian::drives
