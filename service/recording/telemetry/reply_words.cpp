// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/reply_words.hpp"

#include <spdlog/fmt/fmt.h>

#include "meridian/cycle/obey.hpp"
#include "meridian/cycle/state_table.hpp"

namespace meridian::telemetry {
namespace {

[[nodiscard]] bool is_switch(Verb verb) {
  return verb == Verb::kSingleBlock || verb == Verb::kOptionalStop || verb == Verb::kDryRun;
}

[[nodiscard]] bool is_override(Verb verb) {
  return verb == Verb::kFeedOverride || verb == Verb::kRapidOverride;
}

/// What was asked for, and the range of it.
[[nodiscard]] std::string out_of_range(Verb verb, double argument, const MachineModel& model) {
  if (verb == Verb::kJog || verb == Verb::kHome) return "the machine has no such joint";
  if (verb == Verb::kFrame) return "that is no work frame";
  if (verb == Verb::kTool) return "that is no tool table";
  if (verb == Verb::kLimits) return "those are no soft limits";
  if (is_override(verb)) {
    const bool is_feed = verb == Verb::kFeedOverride;
    return fmt::format("{:.6g} % is out of range: from 0 to {:.6g} %{}", 100 * argument,
                       is_feed ? 100 * model.max_feed_override : 100.0,
                       is_feed ? " (feed_override_max_percent of the machine file)" : "");
  }
  const std::string value = fmt::format("{:.6g} is out of range: ", argument);
  if (is_switch(verb)) return value + "on or off";
  if (verb == Verb::kStart) return value + "1 for a dry run alone, 2 for a probing move, else 0";
  if (may_be_dry(verb)) return value + "1 for a dry run alone, else 0";
  return value + "it takes no value";
}

[[nodiscard]] std::string remedy_for_wrong_state(Verb verb, State state) {
  const bool is_by_hand = verb == Verb::kJog || verb == Verb::kHome;
  if (verb == Verb::kDryRun) return "it begins and ends in Off alone; disable first";
  if (is_set_up(verb)) {
    return "the set-up is changed in Off or Ready alone; end what it does first";
  }
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

}  // namespace

std::string describe(Verb verb, State state, double argument) {
  if (is_override(verb)) return fmt::format("{} set to {:.6g} %", name_of(verb), 100 * argument);
  if (is_switch(verb)) {
    return fmt::format("{} {}; the machine is {}", name_of(verb), argument != 0 ? "on" : "off",
                       name_of(state));
  }
  return fmt::format("{} accepted; the machine is {}", name_of(verb), name_of(state));
}

std::string describe(Verb verb, Refusal refusal, State state, double argument,
                     const MachineModel& model) {
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
      why = out_of_range(verb, argument, model);
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
          kMaxStepRamp_s);
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
      why = verb == Verb::kHome
                ? "this is a dry run: every joint has its reference, and no drive searches for one"
                : "this is a dry run, in which nothing is touched; disable, dry-run off, enable";
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
      why = "a hold, an abort or disable was said after it and came first; say it again";
      break;
    case Refusal::kNotJournalled:
      why = "the set-up is kept nowhere; give the service a state_directory, or --state";
      break;
    case Refusal::kNoProbe:
      why = "the drives report no probe that is connected; connect it, then repeat";
      break;
    case Refusal::kProbeContact:
      why = verb == Verb::kResume ? "the probe is in contact; abort, jog it free, start again"
                                  : "the probe is in contact; move it free, then repeat";
      break;
    case Refusal::kGuardOpen:
      why = "a guard of the work space is open; shut it, or jog";
      break;
    case Refusal::kNoEnablingDevice:
      why = "an enabling device is required and none is pressed; press it, then repeat";
      break;
  }
  return fmt::format("{} refused: {}", name_of(verb), why);
}

}  // namespace meridian::telemetry
