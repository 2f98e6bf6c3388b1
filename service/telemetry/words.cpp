// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/words.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/rt/obey.hpp"
#include "meridian/rt/state_table.hpp"
#include "meridian/units.hpp"

namespace meridian::telemetry {
namespace {

[[nodiscard]] bool is_joint(int joint, const MachineModel& model) {
  return joint >= 0 && joint < limited_count(model);
}

[[nodiscard]] std::string joint_name(int joint, const MachineModel& model) {
  return is_joint(joint, model) ? limited_spec(model, joint).name : "?";
}

/// A joint's position or distance with its unit, as people read it.
[[nodiscard]] std::string quantity(double value, int joint, const MachineModel& model) {
  if (is_joint(joint, model) && limited_spec(model, joint).is_rotary) {
    return fmt::format("{:.6g} deg", units::deg_from_rad(value));
  }
  return fmt::format("{:.6g} mm", value);
}

[[nodiscard]] bool is_switch(Verb verb) {
  return verb == Verb::kSingleBlock || verb == Verb::kOptionalStop || verb == Verb::kDryRun;
}

[[nodiscard]] std::string remedy_for_wrong_state(Verb verb, State state) {
  const bool is_by_hand = verb == Verb::kJog || verb == Verb::kHome;
  if (verb == Verb::kDryRun) return "it begins and ends in Off alone; disable first";
  if (verb == Verb::kFrame)
    return "work frames are set in Off or Ready alone; end what it does first";
  switch (state) {
    case State::kJogging:
      return is_by_hand ? "somebody jogs; wait until the joints are let go"
                        : "let the joints go first";
    case State::kHoming:
      return "wait until the drives have their references, or abort";
    case State::kOff:
      return "enable first";
    case State::kFault:
      return "mend the cause, then reset";
    case State::kRunning:
    case State::kApproaching:
      return verb == Verb::kDisable || is_by_hand ? "abort first" : "hold first";
    case State::kReady:
      return "stream a program first";
    case State::kHeld:
    case State::kStarved:
    case State::kStepping:
      return "resume or abort";
    default:
      return "wait until the machine has come to rest";
  }
}

/// "b3 -12.5, b2 +3 mm, theta1 +35 deg": those that move.
[[nodiscard]] std::string joints_moved(const Approach& approach, const MachineModel& model) {
  constexpr double kShown = 5e-5;  // mm or deg
  std::string text, unit;
  for (int joint = 0; joint < model.joint_count; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    const bool is_rotary = model.joints[i].is_rotary;
    const double way = approach.to[i] - approach.from[i];
    const double by = is_rotary ? units::deg_from_rad(way) : way;
    if (std::abs(by) < kShown) continue;
    const std::string own = is_rotary ? " deg" : " mm";
    if (!text.empty()) text += (own == unit ? "" : unit) + ", ";
    text += fmt::format("{} {:+.4g}", joint_name(joint, model), by);
    unit = own;
  }
  return text + unit;
}

/// ", theta1 at 388.6 deg": where the free joint ends, of machines that have one.
[[nodiscard]] std::string winding(const Approach& approach, const MachineModel& model) {
  const int free = free_joint(model);
  if (free < 0) return "";
  const double at = approach.to[static_cast<std::size_t>(free)];
  return fmt::format(", {} at {:.4g} deg", joint_name(free, model), units::deg_from_rad(at));
}

}  // namespace

Weight weight_of(const Event& event) noexcept {
  switch (event.code) {
    case EventCode::kAlarm:
      return Weight::kError;
    case EventCode::kRefused:
    case EventCode::kPeriodsLost:
      return Weight::kWarning;
    case EventCode::kBlockStarted:
    case EventCode::kBlockDone:
    case EventCode::kActionAnswered:
      return Weight::kDetail;
    default:
      return Weight::kNews;
  }
}

std::string drive_names(std::uint32_t mask, const MachineModel& model) {
  std::string names;
  for (int drive = 0; drive < model.joint_count; ++drive) {
    if ((mask >> static_cast<unsigned>(drive) & 1U) == 0) continue;
    names += (names.empty() ? "" : ", ") + drive_spec(model, drive).name;
  }
  return names;
}

std::string describe(const Event& event, const MachineModel& model) {
  switch (event.code) {
    case EventCode::kStateChanged:
      return fmt::format("state {} -> {}", name_of(static_cast<State>(event.b)),
                         name_of(static_cast<State>(event.a)));
    case EventCode::kAccepted:
      if (static_cast<Verb>(event.b) == Verb::kDryRun) {
        return event.x != 0 ? "dry run on: drives stay off, actions are done at once"
                            : "dry run off: drives may be enabled";
      }
      if (static_cast<Verb>(event.b) == Verb::kFrame) {
        return fmt::format("work frame {:.0f} in force", event.x);
      }
      return fmt::format("{} accepted", name_of(static_cast<Verb>(event.b)));
    case EventCode::kRefused:
      return fmt::format("{} refused: {}", name_of(static_cast<Verb>(event.b)),
                         name_of(static_cast<Refusal>(event.x)));
    case EventCode::kBlockStarted:
      return fmt::format("block {} of line {} started", event.a, event.b);
    case EventCode::kBlockDone:
      return fmt::format("block {} of line {} done", event.a, event.b);
    case EventCode::kActionDue:
      return fmt::format("waiting for the action of line {}", event.b);
    case EventCode::kActionAnswered:
      return fmt::format("action of block {} {}", event.a, event.x != 0 ? "done" : "refused");
    case EventCode::kJointsHomed: {
      std::string names;
      for (int joint = 0; joint < model.joint_count; ++joint) {
        if ((event.a >> static_cast<unsigned>(joint) & 1U) == 0) continue;
        names += (names.empty() ? "" : ", ") + joint_name(joint, model);
      }
      return fmt::format("homed: {}", names);
    }
    case EventCode::kProgramEnd:
      return fmt::format("program ended with block {}", event.a);
    case EventCode::kEpochAdvanced:
      return fmt::format("queues emptied, epoch {}", event.a);
    case EventCode::kPlanBegun:
      return "a program is being planned";
    case EventCode::kPlanLooked:
      return fmt::format(
          "branch and winding{} follow from the {} {} blocks{}",
          event.b != 0 ? fmt::format(" past the pole near block {}", event.b) : "",
          event.b != 0 ? "next" : "first", event.a,
          event.x != 0 ? ": the stream stalled before more came. A simulation without the events "
                         "of this recording looks farther and may go otherwise"
                       : "");
    case EventCode::kFeedPlanned:
      return fmt::format("from block {} on planned for {:.4g} % of the feed", event.a,
                         100 * event.x);
    case EventCode::kPeriodsLost:
      return fmt::format("{} periods lost before cycle {}", event.a, event.cycle);
    case EventCode::kStopped:
      return fmt::format("came to rest in {:.3f} s on {:.4g} mm",
                         1e-9 * static_cast<double>(event.a), event.x);
    case EventCode::kAlarm:
      return describe(static_cast<Alarm>(event.a), static_cast<int>(event.b), event.x, event.line,
                      model);
  }
  return fmt::format("event {}", static_cast<int>(event.code));
}

std::string describe(Alarm alarm, int joint, double value, std::uint32_t line,
                     const MachineModel& model) {
  const std::string name = joint_name(joint, model);
  const std::string measured = quantity(value, joint, model);
  std::string text;
  switch (alarm) {
    case Alarm::kNone:
      return "no alarm";
    case Alarm::kNotFinite:
      text = fmt::format("setpoint of {} is not a finite number; report this as a bug", name);
      break;
    case Alarm::kTravel:
      text = fmt::format("setpoint of {} at {} would leave travel; report this as a bug", name,
                         measured);
      break;
    case Alarm::kStep:
      text = fmt::format("setpoint of {} would step by {} in one cycle; report this as a bug", name,
                         measured);
      break;
    case Alarm::kUnreachable:
      text = "no joint positions reach the path; report this as a bug";
      break;
    case Alarm::kDriveFault:
      text = fmt::format("drive {} reports a fault; mend it, then reset", name);
      break;
    case Alarm::kFeedbackLost:
      text = fmt::format(
          "no feedback from {}; check that the drives run and their network, "
          "then reset",
          is_joint(joint, model) ? "drive " + name : "what has the stop input");
      break;
    case Alarm::kFollowingError:
      text = fmt::format(
          "drive {} lags by {} (allowed {}); look for a blocked axis or a weak drive", name,
          measured,
          is_joint(joint, model)
              ? quantity(limited_spec(model, joint).limits.following_error, joint, model)
              : "?");
      break;
    case Alarm::kReferenceLost:
      text = fmt::format("drive {} has lost its reference; reset, enable, then home it", name);
      break;
    case Alarm::kDriveEnabled:
      text = fmt::format(
          "drive {} is enabled in a dry run, and not by this service; switch it off, then reset",
          name);
      break;
    case Alarm::kSetpointsUnheard:
      text = fmt::format(
          "drive {} reports but has taken no setpoint for {:.3g} s; check its gateway, the network "
          "and that it tells the cycle of what it takes, then reset",
          name, value);
      break;
    case Alarm::kDrivesAstray:
      text = fmt::format(
          "drive {} is enabled, moves (by {}) or obeys somebody else where this service does not "
          "ask for it; cut its power, end who commands it, whom the log names, then reset",
          name, measured);
      break;
    case Alarm::kEmergencyStop:
      text = "emergency stop input is open; release it, then reset";
      break;
    case Alarm::kPeriodsLost:
      text = fmt::format(
          "the service missed {:.0f} periods in a row, drives bridge {}; the host is "
          "too busy or not fit for real time",
          value, model.bridge_cycles);
      break;
    case Alarm::kEnableTimeout:
      text = fmt::format(
          "drive {} did not enable in time; check power and drive faults, then reset", name);
      break;
    case Alarm::kHomingFailed:
      text = fmt::format(
          "drive {} found no reference and says so; look at its switch and its homing settings, "
          "then home again",
          name);
      break;
    case Alarm::kHomingTimeout:
      text = fmt::format(
          "drive {} took {:.4g} s over its homing, too long; check that it knows homing mode, its "
          "switch and the machine file's [homing], then home again",
          name, value);
      break;
    case Alarm::kActionFailed:
      text = "the action was refused or not done in time; see to the action peer, then resume";
      break;
  }
  return line > 0 ? fmt::format("{} (line {})", text, line) : text;
}

std::string describe(Verb verb, State state) {
  if (verb == Verb::kFeedOverride || verb == Verb::kRapidOverride) {
    return fmt::format("{} set", name_of(verb));
  }
  if (is_switch(verb)) {
    return fmt::format("{} set; the machine is {}", name_of(verb), name_of(state));
  }
  return fmt::format("{} accepted; the machine is {}", name_of(verb), name_of(state));
}

std::string describe(Verb verb, Refusal refusal, State state) {
  std::string why;
  switch (refusal) {
    case Refusal::kNone:
      break;
    case Refusal::kWrongState:
      why = fmt::format("not in state {}; {}", name_of(state), remedy_for_wrong_state(verb, state));
      break;
    case Refusal::kNotReferenced:
      why = "not every joint that it needs is referenced; home the machine";
      break;
    case Refusal::kNoProgram:
      why = "no program is there; stream one first";
      break;
    case Refusal::kNoFeedback:
      why = "no feedback from the drives; start them and check their network";
      break;
    case Refusal::kProgramPresent:
      why = "a station holds the machine; end its program, or abort it";
      break;
    case Refusal::kOutOfRange:
      why = verb == Verb::kJog || verb == Verb::kHome ? "the machine has no such joint"
            : verb == Verb::kFrame                    ? "that is no work frame"
            : is_switch(verb)                         ? "the value is out of range: on or off"
            : may_be_dry(verb) ? "the value is out of range: 1 for a dry run alone, else 0"
            : verb == Verb::kFeedOverride
                ? "the value is out of range: from 0 to what the machine's file allows "
                  "(feed_override_max_percent)"
                : "the value is out of range: from 0 to 100 %";
      break;
    case Refusal::kStale:
      why =
          "what you saw is older than 500 ms, of an earlier epoch, or of a rest that is behind the "
          "machine; look again, then repeat";
      break;
    case Refusal::kFaultPresent:
      why = "a fault is present; mend its cause, then reset";
      break;
    case Refusal::kSlowRamp:
      why = fmt::format(
          "the machine's override_ramp_s is longer than {} s: blocks could not be braked for in "
          "time",
          kMostStepRamp_s);
      break;
    case Refusal::kDriveEnabled:
      why =
          "a drive is enabled, or was when it was heard last; see that it is off, or start the "
          "service anew where it is gone";
      break;
    case Refusal::kDriveContested:
      why =
          "two sources report the same drive; end the one that is not the machine's, the log names "
          "both";
      break;
    case Refusal::kDryRun:
      why = "this is a dry run: every joint has its reference, and no drive searches for one";
      break;
    case Refusal::kNotDryRun:
      why =
          "it was said for a dry run alone, and this is none: drives would move; disable, then "
          "dry-run on";
      break;
    case Refusal::kDrivesTaken:
      why = "the drives obey another service; end that one, the log names who it is";
      break;
    case Refusal::kDrivesAstray:
      why =
          "drives are enabled or move although the machine has them off; cut their power and end "
          "who commands them, the log names who it is";
      break;
    case Refusal::kOvertaken:
      why = "a hold, an abort or disable was said behind it and came first; say it again";
      break;
    case Refusal::kNotJournalled:
      why = "the set-up is kept nowhere; give the service a state_directory, or --state";
      break;
    case Refusal::kNoEnablingDevice:
      why = "an enabling device is required and none is pressed; press it, then repeat";
      break;
  }
  return fmt::format("{} refused: {}", name_of(verb), why);
}

std::string describe(const PoleEase& ease) {
  return fmt::format("lines {} to {}: tool axis eased by {:.4f} deg, {}", ease.first_line,
                     ease.last_line, units::deg_from_rad(ease.deviation_rad), name_of(ease.reason));
}

std::string describe(const Unwinding& unwinding) {
  return fmt::format(
      "line {}: the free joint would leave its travel; it turns by {:+} turns from {:.3f} deg, {} "
      "mm "
      "off the part",
      unwinding.line, unwinding.turns, units::deg_from_rad(unwinding.from_rad),
      unwinding.retract_mm);
}

std::string describe(const Approach& approach, const MachineModel& model, std::size_t room) {
  const std::string head = fmt::format("approach to line {}: ", approach.line);
  const std::string joints = joints_moved(approach, model);
  if (joints.empty() && !approach.has_rest) return head + "none, the tool is there";
  const auto lift = [](const char* way, double by_mm) {
    return by_mm > 0 ? fmt::format("{} {:.4g} mm, ", way, by_mm) : "";
  };
  // Where tool and spindle act next nobody may think that the tool is farther off than it is.
  const std::string begin =
      approach.has_rest
          ? fmt::format("up {:.4g} of {:.4g} mm{}, actions, ", approach.retract, model.clearance_mm,
                        is_short_of_clearance(approach, model) ? " (NEAR THE PART)" : "")
          : "";
  const std::string ways =
      (approach.has_rest ? lift("up", approach.lift) : lift("up", approach.retract)) +
      (joints.empty() ? "" : "joints straight " + joints + ", ") + lift("down", approach.descent);
  const std::string trip = fmt::format("{:.4g} mm in {:.1f} s, branch {}", approach.length,
                                       approach.time, approach.branch);
  const std::string turned = winding(approach, model);
  const std::string front = head + begin;
  if ((front + ways + trip + turned).size() <= room) return front + ways + trip + turned;
  return (front + ways + trip).size() <= room ? front + ways + trip : front + trip;
}

bool is_short_of_clearance(const Approach& approach, const MachineModel& model) noexcept {
  constexpr double kSame_mm = 1e-3;
  return approach.has_rest && approach.retract < model.clearance_mm - kSame_mm;
}

}  // namespace meridian::telemetry
