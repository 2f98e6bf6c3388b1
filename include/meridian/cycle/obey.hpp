// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/dry_run.hpp"
#include "meridian/cycle/jog/homing.hpp"
#include "meridian/cycle/jog/jogging.hpp"
#include "meridian/cycle/jog/probing.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/stop/follow_plan.hpp"
#include "meridian/cycle/stop/stop_motion.hpp"
#include "meridian/cycle/supervise.hpp"

/// The operator's word: table first, then the conditions that a table cannot hold. RT: cycle.
namespace meridian {

/// At rest: everything planned is void, and all that travels later carries the next epoch.
inline void drop_program(Cycle& c) noexcept {
  c.state.has_block = false;
  c.state.probing.state = ProbeState::kOff;
  c.state.single_block.phase = SingleBlock::Phase::kRunning;
  c.state.piece_time = 0;
  c.state.program_time = 0;
  // What it waited for, or was answered, is not of the program that comes.
  c.state.barrier_time = 0;
  c.state.action = ActionState::kNotReported;
  c.state.epoch = static_cast<std::uint16_t>(c.state.epoch + 1);
  c.reader.set_epoch(c.state.epoch);
  emit(c, EventCode::kEpochAdvanced, c.state.epoch);
}

/// Begins or ends the dry run: what was sent for the one is not run as the other, and where the
/// drives are, only they know.
inline void set_dry_run(Cycle& c, bool is_on) noexcept {
  if (c.state.is_dry_run == is_on) return;
  c.state.is_dry_run = is_on;
  if (!is_on) c.state.joints = {};
  drop_program(c);
}

/// The joints that `home` names; 0: none, or what is no mask.
[[nodiscard]] inline std::uint32_t joints_to_home(const MachineModel& machine,
                                                  double argument) noexcept {
  const std::uint32_t all = all_joints(machine);
  if (!(argument >= 0 && argument <= all) || argument != std::floor(argument)) return 0;
  return argument == 0 ? all : static_cast<std::uint32_t>(argument);
}

/// Why no hand may be laid on the joints now. What a station has sent is planned from where the
/// machine stands.
[[nodiscard]] inline Refusal condition_of_hand(const Cycle& c, const Command& command) noexcept {
  if (c.in.session != 0) return Refusal::kProgramPresent;
  if (command.verb == Verb::kHome) {
    if (c.state.is_dry_run) return Refusal::kDryRun;
    return joints_to_home(c.machine, command.argument) != 0 ? Refusal::kNone : Refusal::kOutOfRange;
  }
  const double what = command.argument, tool = what - kMaxJoints;
  const bool is_joint = what >= 0 && what < c.machine.joint_count;
  if (!is_joint && !(tool >= 0 && tool < kToolAxisCount)) return Refusal::kOutOfRange;
  const auto joint = static_cast<int>(what);
  return may_jog(c.machine, joint, c.drives.referenced_mask) ? Refusal::kNone
                                                             : Refusal::kNotReferenced;
}

/// Why the machine may not be enabled now: of a dry run, because the emergency input is open, a
/// drive is on, drives obey another service, or two sources say that they are the same drive.
/// Drives wait for an emergency input that was open when it was heard last.
[[nodiscard]] inline Refusal condition_of_enable(const Cycle& c) noexcept {
  const bool is_dry = c.state.is_dry_run;
  if (is_dry && is_drive_enabled(c)) return Refusal::kDriveEnabled;
  if (!is_dry && !is_feedback_there(c)) return Refusal::kNoFeedback;
  if (!is_dry && (c.drives.contested_mask & all_joints(c.machine)) != 0) {
    return Refusal::kDriveContested;
  }
  if (!is_dry && (c.drives.foreign_mask & all_joints(c.machine)) != 0) return Refusal::kDrivesTaken;
  const bool has_fault = !is_dry && (c.drives.fault_mask & all_joints(c.machine)) != 0;
  const bool is_open = is_dry ? is_emergency_heard(c.machine, c.in) : c.drives.emergency_stop;
  return is_open || has_fault ? Refusal::kFaultPresent : Refusal::kNone;
}

[[nodiscard]] inline Refusal condition_of_dry_run(const Cycle& c, double argument) noexcept {
  if (argument != 0 && argument != 1) return Refusal::kOutOfRange;
  return argument == 1 && is_drive_enabled(c) ? Refusal::kDriveEnabled : Refusal::kNone;
}

/// Why a program may not seek contact now: it would begin with it, or nobody would report it.
[[nodiscard]] inline Refusal condition_of_probe(const Cycle& c) noexcept {
  if (c.drives.probe == ProbeInput::kNone) return Refusal::kNoProbe;
  return c.drives.probe == ProbeInput::kContact ? Refusal::kProbeContact : Refusal::kNone;
}

/// Why a start as a probing move is refused: only a program that is loaded begins as one, and one
/// that is under way is no other.
[[nodiscard]] inline Refusal condition_of_probing_start(const Cycle& c) noexcept {
  if (c.state.is_dry_run) return Refusal::kDryRun;
  if (c.state.probing.state == ProbeState::kSeeking) return Refusal::kNone;
  const VerbEffect effect = effect_of(c.state.state, Verb::kStart);
  if (effect.effect == Effect::kRefused) return effect.refusal;
  return c.state.state == State::kLoaded ? condition_of_probe(c) : Refusal::kWrongState;
}

/// Why a word that may be said for a dry run or a probing move alone is refused, whatever the table
/// says: no word for a dry run leads on towards a cut.
[[nodiscard]] inline Refusal condition_of_kind(const Cycle& c, const Command& command) noexcept {
  if (!may_be_dry(command.verb) || command.argument == 0) return Refusal::kNone;
  const bool is_probing = command.verb == Verb::kStart && command.argument == kStartProbing;
  if (is_probing) return condition_of_probing_start(c);
  if (command.argument != 1) return Refusal::kOutOfRange;
  return c.state.is_dry_run ? Refusal::kNone : Refusal::kNotDryRun;
}

/// Why a verb that the table allows is refused now; kNone: it is not, and what a start or a resume
/// goes on with is taken up.
[[nodiscard]] inline Refusal take_up(Cycle& c, const Command& command) noexcept {
  const Feedback& f = c.drives;
  const std::uint32_t all = all_joints(c.machine);
  const bool goes_on = command.verb == Verb::kStart || command.verb == Verb::kResume;
  if (goes_on && c.state.probing.state == ProbeState::kSeeking) {
    const Refusal refusal = condition_of_probe(c);
    if (refusal != Refusal::kNone) return refusal;
  }
  switch (command.verb) {
    case Verb::kEnable:
      return condition_of_enable(c);
    case Verb::kDryRun:
      return condition_of_dry_run(c, command.argument);
    case Verb::kStart:
      if ((f.referenced_mask & all) != all) return Refusal::kNotReferenced;
      return !c.state.single_block.is_resting() || leave_block(c) ? Refusal::kNone
                                                                  : Refusal::kNoProgram;
    case Verb::kResume:
      if (c.state.single_block.is_resting()) {
        return leave_block(c) ? Refusal::kNone : Refusal::kNoProgram;
      }
      return c.reader.piece() != nullptr || next_piece(c) ? Refusal::kNone : Refusal::kNoProgram;
    case Verb::kReset:
      if (c.state.watch.is_astray) return Refusal::kDrivesAstray;
      return is_emergency_heard(c.machine, c.in) ? Refusal::kFaultPresent : Refusal::kNone;
    case Verb::kFeedOverride:
    case Verb::kRapidOverride: {
      const double max = command.verb == Verb::kFeedOverride ? c.machine.max_feed_override : 1.0;
      return command.argument >= 0 && command.argument <= max ? Refusal::kNone
                                                              : Refusal::kOutOfRange;
    }
    case Verb::kSingleBlock:
      if (command.argument == 1 && c.machine.override_ramp_s > kMaxStepRamp_s) {
        return Refusal::kSlowRamp;
      }
      [[fallthrough]];
    case Verb::kOptionalStop:
      return command.argument == 0 || command.argument == 1 ? Refusal::kNone : Refusal::kOutOfRange;
    case Verb::kJog:
    case Verb::kHome:
      return condition_of_hand(c, command);
    case Verb::kFrame:
    case Verb::kTool:
    case Verb::kLimits:  // what a station sends was checked with the set-up of now
      return c.in.session != 0 ? Refusal::kProgramPresent : Refusal::kNone;
    default:
      return Refusal::kNone;
  }
}

/// Steps over a program stop that the machine is held at, and goes on.
inline void resume(Cycle& c) noexcept {
  const TimeKind kind = c.reader.piece()->kind;
  const bool is_held = c.state.state == State::kHeld && c.state.barrier_time > 0;
  if (is_held && (kind == TimeKind::kStop || kind == TimeKind::kOptionalStop)) next_piece(c);
  enter(c, running_state(c));
}

/// Brings to rest what moves: the program, a joint that is jogged, drives that are homing.
inline void begin_rest(Cycle& c) noexcept {
  if (c.state.jogging.is_active()) return brake_jogging(c.state.jogging, false);
  if (c.state.homing.is_active()) return halt_homing(c.state.homing);
  if (!c.state.stop.is_active()) begin_stop(c, StopKind::kHold);
}

/// Goes to the state that the table names, as `command` asks for.
inline void go(Cycle& c, State next, const Command& command) noexcept {
  switch (next) {
    case State::kEnabling:
      if (c.state.is_dry_run) {
        stand_dry(c);
      } else {
        take_over_feedback(c);
      }
      c.previous = c.state.joints;
      break;
    case State::kDisabling:
      drop_program(c);
      break;
    case State::kApproaching:
      c.state.program_time = 0;
      c.state.single_block.next_block = 0;
      begin_probing(c, command.argument == kStartProbing);
      report_block(c);
      break;
    case State::kHolding:
    case State::kAborting:
      begin_rest(c);
      break;
    case State::kRunning:
      return resume(c);
    case State::kJogging:
      c.state.jogging = begin_jogging(command.request, c.in.jog.sample);
      c.state.motion = MotionKind::kApproach;
      break;
    case State::kHoming:
      c.state.homing =
          begin_homing(c.machine, c.state.options, joints_to_home(c.machine, command.argument));
      break;
    case State::kOff:
      c.state.alarm = Alarm::kNone;
      c.state.alarms_reported = 0;
      break;
    default:
      break;
  }
  enter(c, next);
}

/// A stop comes ahead of words that were said before it, and what would have led to motion of these
/// is void, whether or not there was anything to stop.
[[nodiscard]] inline Refusal condition_of_turn(const Command& command,
                                               std::uint64_t stop_said) noexcept {
  const bool is_overtaken = leads_to_motion(command.verb) && command.request < stop_said;
  return is_overtaken ? Refusal::kOvertaken : Refusal::kNone;
}

/// Does what the command asks for, or refuses it; either is reported with the request's number.
/// Rare: out of the way of the cycles between.
[[gnu::noinline]] inline void obey_word(Cycle& c) noexcept {
  const Command& command = c.in.command;
  const VerbEffect effect = effect_of(c.state.state, command.verb);
  const bool is_asked = effect.effect == Effect::kGo || effect.effect == Effect::kSet;
  if (is_stop(command.verb)) c.state.stop_said = std::max(c.state.stop_said, command.request);
  Refusal refusal = condition_of_turn(command, c.state.stop_said);
  if (refusal == Refusal::kNone) refusal = condition_of_kind(c, command);
  if (refusal == Refusal::kNone) refusal = is_asked ? take_up(c, command) : effect.refusal;
  if (refusal != Refusal::kNone) {
    emit(c, EventCode::kRefused, command.request, static_cast<std::uint64_t>(command.verb),
         static_cast<double>(refusal));
    return;
  }
  emit(c, EventCode::kAccepted, command.request, static_cast<std::uint64_t>(command.verb),
       command.argument);
  if (effect.effect == Effect::kGo) go(c, effect.next, command);
  if (command.verb == Verb::kFeedOverride) {
    c.state.feed_override = command.argument;
    c.reader.ask_feed(command.argument);
  }
  if (command.verb == Verb::kRapidOverride) c.state.rapid_override = command.argument;
  if (command.verb == Verb::kOptionalStop) c.state.stops_at_optional = command.argument != 0;
  // A brake that is on stays on, whatever is said: no end is left out by that.
  if (command.verb == Verb::kSingleBlock) c.state.single_block.is_on = command.argument != 0;
  if (command.verb == Verb::kDryRun) set_dry_run(c, command.argument != 0);
}

inline void obey(Cycle& c) noexcept {
  if (c.in.has_command) obey_word(c);
}

}  // namespace meridian
