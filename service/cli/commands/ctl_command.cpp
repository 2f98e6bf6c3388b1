// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/state_table.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/frame_options.hpp"
#include "service/cli/options/operator/hand_options.hpp"
#include "service/cli/options/operator/limits_options.hpp"
#include "service/cli/options/operator/move_options.hpp"
#include "service/cli/options/operator/probing_options.hpp"
#include "service/cli/options/operator/tool_options.hpp"
#include "service/cli/options/operator/touch_off_options.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/cli/status_text.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli::ctl_command {

namespace {

struct CtlOptions {
  PeerOptions peer;
  std::string verb, wait, operator_name;
  std::vector<std::string> values;
  JogOptions jog;
  std::vector<const CLI::Option*> of_jog;  ///< what is said of a jog alone
  FrameOptions frame;
  std::vector<const CLI::Option*> of_frame;
  ToolOptions tool;
  std::vector<const CLI::Option*> of_tool;
  TouchOffOptions touch_off;
  std::vector<const CLI::Option*> of_touch_off;
  MoveOptions move;
  std::vector<const CLI::Option*> of_move;
  std::optional<double> retract_mm;
  const CLI::Option* retract = nullptr;
  double wait_s = 60;
  bool is_for_dry_run = false;
};

/// No verbs of the machine: they become others of its verbs.
constexpr const char* kTouchOff = "touch-off";
constexpr const char* kMove = "move";
constexpr const char* kProbe = "probe";

const std::map<std::string, Verb>& verbs() {
  static const std::map<std::string, Verb> kVerbs{{"enable", Verb::kEnable},
                                                  {"disable", Verb::kDisable},
                                                  {"start", Verb::kStart},
                                                  {"hold", Verb::kHold},
                                                  {"resume", Verb::kResume},
                                                  {"abort", Verb::kAbort},
                                                  {"reset", Verb::kReset},
                                                  {"override", Verb::kFeedOverride},
                                                  {"rapid-override", Verb::kRapidOverride},
                                                  {"jog", Verb::kJog},
                                                  {"home", Verb::kHome},
                                                  {"single-block", Verb::kSingleBlock},
                                                  {"optional-stop", Verb::kOptionalStop},
                                                  {"dry-run", Verb::kDryRun},
                                                  {"frame", Verb::kFrame},
                                                  {"tool", Verb::kTool},
                                                  {"limits", Verb::kLimits}};
  return kVerbs;
}

int wait_for(stream::OperatorLink& link, const dds::Reply& reply, const CtlOptions& options) {
  const State wanted = *parse_state(options.wait);
  // In a fault the machine stays until it is reset: no use waiting on.
  const auto is_over = [wanted](State state) { return state == wanted || state == State::kFault; };
  State last = reply.state;
  const auto reached = link.wait_for_state(
      reply, is_over, [&last](const dds::Status& status) { last = status.state; },
      std::chrono::milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3)));
  if (reached == wanted) {
    std::printf("%s\n", text_of(wanted));
    return kFine;
  }
  const std::string message = link.status() ? link.status()->message : "";
  std::fprintf(stderr, "meridian: machine is %s, not %s%s%s\n", text_of(last), text_of(wanted),
               message.empty() ? "" : ": ", message.c_str());
  return kVerdictNo;
}

[[nodiscard]] bool is_said(const CLI::Option* option) { return option->count() > 0; }

[[nodiscard]] bool has_any(const std::vector<const CLI::Option*>& of) {
  return std::any_of(of.begin(), of.end(), is_said);
}

/// What is wrong with the options beside the verb; nullptr: nothing.
[[nodiscard]] const char* misplaced(Verb verb, const CtlOptions& options) {
  if (options.is_for_dry_run && !may_be_dry(verb)) return "--dry-run is for enable and start alone";
  if (verb == Verb::kJog) {
    return options.wait.empty() ? nullptr
                                : "--wait is not for jog, which ends when the joint rests";
  }
  if (verb != Verb::kFrame && has_any(options.of_frame))
    return "--at and --name are for frame alone";
  if (verb != Verb::kTool && has_any(options.of_tool)) {
    return "--length, --radius and the like are for tool, touch-off and probe alone";
  }
  if (has_any(options.of_touch_off)) {
    return "--touches, --toward, --as, --height and --confirm are for touch-off alone, the first "
           "two "
           "for probe too";
  }
  if (has_any(options.of_move))
    return "--tip, --joints, --to and --feed are for move and probe alone";
  if (is_said(options.retract)) return "--retract is for probe alone";
  const bool has_jog = has_any(options.of_jog);
  return has_jog ? "--for and --dead-man are for jog alone, --distance for probe too" : nullptr;
}

std::optional<double> switch_of(const CtlOptions& options) {
  const std::string value = options.values.size() == 1 ? options.values.front() : "";
  if (value == "on" || value == "off") return value == "on" ? 1 : 0;
  std::fprintf(stderr, "meridian: %s takes on or off\n", options.verb.c_str());
  return std::nullopt;
}

/// The argument of a verb that has one by itself, 0 for others; or says what is wrong.
std::optional<double> argument_of(Verb verb, const CtlOptions& options) {
  const bool is_switch =
      verb == Verb::kSingleBlock || verb == Verb::kOptionalStop || verb == Verb::kDryRun;
  if (is_switch) return switch_of(options);
  const bool is_override = verb == Verb::kFeedOverride || verb == Verb::kRapidOverride;
  const bool has_joints = verb == Verb::kJog || verb == Verb::kHome || is_set_up(verb);
  double percent = 0;
  bool is_right = has_joints || options.values.size() == (is_override ? 1U : 0U);
  if (is_right && is_override) {
    is_right = CLI::detail::lexical_cast(options.values.front(), percent) && std::isfinite(percent);
  }
  if (is_right) return percent / 100;
  std::fprintf(stderr, "meridian: %s takes %s\n", options.verb.c_str(),
               is_override ? "a value in %" : "no value");
  return std::nullopt;
}

/// More than one service of a machine is a fake, or two hosts that find each other only now.
void warn_of_others(const stream::OperatorLink& link, const std::string& machine) {
  const std::vector<std::string> services = link.services();
  if (services.size() < 2) return;
  std::fprintf(stderr,
               "meridian: WARNING: %zu services speak for machine %s; end those that are "
               "not its own:\n",
               services.size(), machine.c_str());
  for (const std::string& service : services) std::fprintf(stderr, "  %s\n", service.c_str());
}

[[nodiscard]] ProbingOptions probing_of(const CtlOptions& options) {
  return {options.touch_off.toward, options.jog.distance, options.move.feed,
          options.touch_off.touches, options.retract_mm};
}

/// What is wrong with the options beside a composed verb; nullptr: nothing.
[[nodiscard]] const char* misplaced_beside(const CtlOptions& options) {
  if (options.is_for_dry_run) return "--dry-run is for enable and start alone";
  if (has_any(options.of_frame)) return "--at and --name are for frame alone";
  if (!options.wait.empty()) return "--wait is not for move, probe and touch-off";
  const bool is_probe = options.verb == kProbe, is_move = options.verb == kMove;
  if (is_said(options.retract) && !is_probe) return "--retract is for probe alone";
  const bool has_target =
      !options.move.tip.empty() || !options.move.joints.empty() || !options.move.position.empty();
  if (has_target && !is_move) return "--tip, --joints and --to are for move alone";
  if (is_move && (has_any(options.of_touch_off) || has_any(options.of_tool))) {
    return "options of a touch are for touch-off and probe alone";
  }
  const TouchOffOptions& touch = options.touch_off;
  if (is_probe && (!touch.as.empty() || touch.height || touch.is_confirmed)) {
    return "--as, --height and --confirm are for touch-off alone";
  }
  const bool has_distance = options.jog.distance != 0;
  if (has_distance && !is_probe) return "--distance is for jog and probe alone";
  const auto count = std::count_if(options.of_jog.begin(), options.of_jog.end(), is_said);
  return count > (has_distance ? 1 : 0) ? "--for and --dead-man are for jog alone" : nullptr;
}

/// What is found becomes a word of `frame` or `tool`, a move a program and its `start`.
int run_composed(CtlOptions& options) {
  if (!options.values.empty() && options.verb != kTouchOff) {
    std::fprintf(stderr, "meridian: %s\n",
                 options.verb == kMove
                     ? "move takes --tip, --joints or --to, and --feed alone"
                     : "probe takes --toward, --distance, --feed, --touches and --retract alone");
    return kUsage;
  }
  if (const char* const wrong = misplaced_beside(options)) {
    std::fprintf(stderr, "meridian: %s\n", wrong);
    return kUsage;
  }
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  stream::OperatorLink link(participant, options.operator_name);
  if (options.verb == kMove) {
    return run_move(options.move, *machine, participant, link, options.operator_name, options.peer);
  }
  if (options.verb == kProbe) {
    return run_probing(probing_of(options), options.tool, *machine, participant, link,
                       options.operator_name, options.peer);
  }
  return run_touch_off(options.values, options.touch_off, options.tool, *machine, link,
                       options.peer.timeout());
}

int run_ctl(CtlOptions& options) {
  const bool is_composed =
      options.verb == kTouchOff || options.verb == kMove || options.verb == kProbe;
  if (is_composed) return run_composed(options);
  const Verb verb = verbs().at(options.verb);
  std::optional<double> argument = argument_of(verb, options);
  if (!argument) return kUsage;
  if (const char* const wrong = misplaced(verb, options)) {
    std::fprintf(stderr, "meridian: %s\n", wrong);
    return kUsage;
  }
  if (options.is_for_dry_run) *argument = 1;
  if (!options.wait.empty() && !parse_state(options.wait)) {
    std::fprintf(stderr, "meridian: --wait %s: no such state; there are %s\n", options.wait.c_str(),
                 all_states().c_str());
    return kUsage;
  }
  std::optional<FrameOrder> order;
  const bool is_list = (verb == Verb::kFrame || verb == Verb::kLimits) &&
                       options.values == std::vector<std::string>{"list"};
  if (verb == Verb::kFrame && !is_list) {
    order = frame_order(options.values, options.frame);
    if (!order) return kUsage;
  }
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  if (is_list) {
    const bool is_frame = verb == Verb::kFrame;
    std::fputs((is_frame ? frames_text(*machine) : limits_text(*machine)).c_str(), stdout);
    return kFine;
  }
  if (verb == Verb::kHome && (*argument = home_argument(*machine, options.values)) < 0) {
    return kUsage;
  }
  std::optional<LimitsOrder> limits;
  if (verb == Verb::kLimits && !(limits = limits_order(options.values, *machine))) return kUsage;
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  stream::OperatorLink link(participant, options.operator_name);
  if (verb == Verb::kTool && is_tool_question(options.values)) {
    (void)link.wait_for_status(options.peer.timeout());
    return answer_tool_question(options.values, *machine, link.status() ? link.status()->tool : 0);
  }
  std::optional<ToolOrder> tools;
  if (verb == Verb::kTool && !(tools = tool_order(options.values, options.tool, *machine))) {
    return kUsage;
  }
  if (verb == Verb::kJog) {
    return run_jog(participant, link, *machine, options.values, options.jog, options.peer);
  }
  const auto timeout = options.peer.timeout();
  const auto reply = order    ? link.ask(*order, timeout)
                     : limits ? link.ask(*limits, timeout)
                     : tools  ? link.ask_for_tools(tools->file, tools->tools_seen, timeout)
                              : link.ask(verb, *argument, timeout);
  warn_of_others(link, options.peer.machine);
  if (!reply) {
    std::fprintf(stderr, "meridian: machine %s does not answer\n", options.peer.machine.c_str());
    return kNoPeer;
  }
  std::fprintf(reply->is_accepted ? stdout : stderr, "%s: %s\n",
               reply->is_accepted ? "accepted" : "refused", reply->text.c_str());
  std::fflush(stdout);
  if (!reply->is_accepted) return kMachineRefused;
  return options.wait.empty() ? kFine : wait_for(link, *reply, options);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CtlOptions>();
  CLI::App* command = app.add_subcommand(
      "ctl", "Ask the machine for something, print `accepted` or `refused` and why");
  std::vector<std::string> names;
  for (const auto& [name, verb] : verbs()) names.push_back(name);
  names.emplace_back(kTouchOff);
  names.emplace_back(kMove);
  names.emplace_back(kProbe);
  command->add_option("verb", options->verb, CLI::detail::join(names, ", "))
      ->required()
      ->check(CLI::IsMember(names))
      ->type_name("VERB");
  command
      ->add_option(
          "value", options->values,
          "override: 0 to feed_override_max_percent of the machine's file (150), "
          "rapid-override: 0 to 100 %; jog: JOINT (or tool-x, -y, -z, -a, -b) and its "
          "velocity in mm/s or deg/s; home: "
          "joints, default all; single-block, optional-stop, dry-run: on or off; frame: set, "
          "select or clear and a number, or list; tool: set or clear and a number, load or save "
          "and a file, or list; limits: set, a joint and both ends in mm or deg, clear and a joint "
          "or all, keep-out, a name and joints with both ends, open and a name or all, tip and two "
          "corners X,Y,Z over the base in mm, clear tip, or list; "
          "touch-off: touch, frame and a number, or tool and a number; move and probe: "
          "none")
      ->type_name("VALUE");
  CLI::Option* const time =
      command->add_option("--for", options->jog.for_s, "jog: how long the joint is held, s")
          ->check(finite_range(1e-3, 1e6));
  CLI::Option* const distance =
      command
          ->add_option("--distance", options->jog.distance,
                       "jog: the joint rests exactly so far from where it began, mm or deg; probe: "
                       "the tip goes no farther, mm")
          ->check(finite_range(1e-6, 1e6));
  CLI::Option* const dead_man =
      command
          ->add_option(
              "--dead-man", options->jog.dead_man_ms,
              "jog: the joint comes to rest where the machine hears nothing for so long, ms")
          ->capture_default_str()
          ->check(finite_range(60.0, 500.0));
  options->of_jog = {time, distance, dead_man};
  CLI::Option* const at =
      command->add_option("--at", options->frame.at,
                          "frame set: where the workpiece lies: x,y,z[,a,b,c] in mm and deg, Rz(c) "
                          "Ry(b) Rx(a)");
  CLI::Option* const name =
      command->add_option("--name", options->frame.name, "frame set: what it is called");
  options->of_frame = {at, name};
  options->of_tool = add_tool_options(*command, options->tool);
  options->of_touch_off = add_touch_off_options(*command, options->touch_off);
  options->of_move = add_move_options(*command, options->move);
  options->retract = command
                         ->add_option("--retract", options->retract_mm,
                                      "probe: back along the line by so much from the contact, mm")
                         ->check(finite_range(1e-3, 1e4));
  CLI::Option* const wait =
      command
          ->add_option(
              "--wait", options->wait,
              "Wait until the machine is in this state; exit code 1 where it does not come")
          ->type_name("STATE");
  command->add_option("--wait-time", options->wait_s, "How long --wait waits, s")
      ->capture_default_str()
      ->check(finite_range(0.0, 1e7))
      ->needs(wait);
  command->add_flag("--dry-run", options->is_for_dry_run,
                    "enable, start: for a dry run alone; refused where the machine is in none");
  const char* user = std::getenv("USER");
  options->operator_name = user != nullptr ? user : "operator";
  command->add_option("--operator", options->operator_name, "Who asks, for the log")
      ->capture_default_str();
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run_ctl(*options); });
}

}  // namespace meridian::cli::ctl_command
