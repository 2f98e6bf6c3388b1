// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/words.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
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

/// "b3 -12.5, b2 +3 mm, theta1 +35 deg": those that move.
[[nodiscard]] std::string joints_moved(const Approach& approach, const MachineModel& model) {
  constexpr double kShown = 5e-5;  // mm or deg
  std::string text, unit;
  for (int joint = 0; joint < model.joint_count; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    const bool is_rotary = model.joints[i].is_rotary;
    const double distance = approach.to[i] - approach.from[i];
    const double by = is_rotary ? units::deg_from_rad(distance) : distance;
    if (std::abs(by) < kShown) continue;
    const std::string own = is_rotary ? " deg" : " mm";
    if (!text.empty()) text += (own == unit ? "" : unit) + ", ";
    text += fmt::format("{} {:+.4g}", joint_name(joint, model), by);
    unit = own;
  }
  return text + unit;
}

/// ", theta1 at 388.6 deg": where the redundant joint ends, of machines that have one.
[[nodiscard]] std::string winding(const Approach& approach, const MachineModel& model) {
  const int free = redundant_joint(model);
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
    case EventCode::kContactJoint:
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
      if (static_cast<Verb>(event.b) == Verb::kTool) return "another tool table in force";
      if (static_cast<Verb>(event.b) == Verb::kLimits) return "other soft limits in force";
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
    case EventCode::kContactJoint:
      return fmt::format("{} {} was at {}", event.b == 0 ? "contact:" : "the report before:",
                         joint_name(static_cast<int>(event.a), model),
                         quantity(event.x, static_cast<int>(event.a), model));
    case EventCode::kContactFound:
      return fmt::format("the probe has contact, {} period{} after the report before", event.a,
                         event.a == 1 ? "" : "s");
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
          "and that it reports the cycle of the setpoint it took, then reset",
          name, value);
      break;
    case Alarm::kDrivesAstray:
      text = fmt::format(
          "drive {} is enabled, moves (by {}) or obeys somebody else where this service does not "
          "ask for it; cut its power, end who commands it, whom the log names, then reset",
          name, measured);
      break;
    case Alarm::kKeepOut:
      text = fmt::format("a setpoint would enter the keep-out box {}; report this as a bug",
                         model.keep_out.name_of(value));
      break;
    case Alarm::kTipBox:
      text = fmt::format(
          "a setpoint would take the tip out of the tip box, {} at {:.6g} mm over the base; reset "
          "and jog the tip back; without an alarm before it report this as a bug",
          "XYZ"[joint >= 0 && joint < 3 ? joint : 0], value);
      break;
    case Alarm::kNoContact:
      text = "the probe found no contact within the distance; look where the workpiece is";
      break;
    case Alarm::kContact:
      text =
          "the probe touched something in a motion that was no probing move; reset, enable and jog "
          "it free";
      break;
    case Alarm::kProbeLost:
      text =
          "the probe is connected no more; look at its plug, its battery and its receiver, then "
          "reset";
      break;
    case Alarm::kStandstill:
      text = fmt::format(
          "joint {} moved by {} where it was to stand; look for a drive that creeps, a brake or a "
          "load, then reset",
          name, measured);
      break;
    case Alarm::kJointSpeed:
      text = fmt::format(
          "joint {} was led or pushed by {} per second with an open guard; jog slower or shut it, "
          "then reset",
          name, measured);
      break;
    case Alarm::kTipSpeed:
      text = fmt::format(
          "the tip moved at {:.4g} mm/min with an open guard; jog slower or shut it, then reset",
          units::per_min_from_per_s(value));
      break;
    case Alarm::kPositionWindow:
      text = fmt::format("joint {} is at {}, outside of its window; reset, enable and jog it back",
                         name, measured);
      break;
    case Alarm::kDriveModel:
      text = fmt::format(
          "drive {} is {} off the model of it; look for a blocked axis, a weak drive, or a lag "
          "that "
          "is not that of the machine file's [monitoring]",
          name, measured);
      break;
    case Alarm::kFeedbackJump:
      text = fmt::format(
          "drive {} reports a jump of {}, farther than it can move; look at its encoder and cable, "
          "then home it",
          name, measured);
      break;
    case Alarm::kFeedbackFrozen:
      text = fmt::format(
          "drive {} reports the same position although it was led on by {}; look at its encoder, "
          "its coupling and its reports",
          name, measured);
      break;
    case Alarm::kFeedbackTooFast:
      text = fmt::format(
          "drive {} reports {} per second, faster than it can move; look at its encoder and its "
          "scale, then reset",
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

std::string describe(const RelaxedAxis& relaxed_axis) {
  return fmt::format("lines {} to {}: tool axis relaxed by {:.4f} deg, {}", relaxed_axis.first_line,
                     relaxed_axis.last_line, units::deg_from_rad(relaxed_axis.deviation_rad),
                     name_of(relaxed_axis.reason));
}

std::string describe(const Rewind& rewind) {
  const std::string by =
      rewind.is_other_branch()
          ? fmt::format("{:+.3f} deg to the other branch", units::deg_from_rad(rewind.turn_rad))
          : fmt::format("{:+} turns", rewind.turns);
  return fmt::format(
      "line {}: a joint would leave its travel; the redundant joint turns by {} from {:.3f} "
      "deg, {} mm off the part",
      rewind.line, by, units::deg_from_rad(rewind.from_rad), rewind.retract_mm);
}

std::string describe(const Approach& approach, const MachineModel& model, std::size_t room) {
  const std::string head = fmt::format("approach to line {}: ", approach.line);
  const std::string joints = joints_moved(approach, model);
  if (joints.empty() && !approach.has_rest) return head + "none, the tool is there";
  const auto lift = [](const char* direction, double by_mm) {
    return by_mm > 0 ? fmt::format("{} {:.4g} mm, ", direction, by_mm) : "";
  };
  // Where tool and spindle act next nobody may think that the tool is farther off than it is.
  const std::string begin =
      approach.has_rest
          ? fmt::format("up {:.4g} of {:.4g} mm{}, actions, ", approach.retract, model.clearance_mm,
                        is_short_of_clearance(approach, model) ? " (NEAR THE PART)" : "")
          : "";
  const std::string lifts =
      (approach.has_rest ? lift("up", approach.lift) : lift("up", approach.retract)) +
      (joints.empty() ? "" : "joints straight " + joints + ", ") + lift("down", approach.descent);
  const std::string trip = fmt::format("{:.4g} mm in {:.1f} s, branch {}", approach.length,
                                       approach.time, approach.branch);
  const std::string turned = winding(approach, model);
  const std::string front = head + begin;
  if ((front + lifts + trip + turned).size() <= room) return front + lifts + trip + turned;
  return (front + lifts + trip).size() <= room ? front + lifts + trip : front + trip;
}

bool is_short_of_clearance(const Approach& approach, const MachineModel& model) noexcept {
  constexpr double kSame_mm = 1e-3;
  return approach.has_rest && approach.retract < model.clearance_mm - kSame_mm;
}

}  // namespace meridian::telemetry
