// SPDX-License-Identifier: Apache-2.0
#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/joint_masks.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/drives_check.hpp"
#include "service/cli/injection_console.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_name_option.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/cli/stoppable_output.hpp"
#include "service/drives/kit/line_reporter.hpp"
#include "service/drives/kit/other_source.hpp"
#include "service/drives/simulated/simulated_drives.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/text/whole_file.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli::drives_command {

namespace {

struct DrivesOptions {
  std::string machine_file, partition;
  std::uint32_t domain = 0;
  std::string lag = "second";
  double time_constant_ms = 2;
  bool has_no_actions = false, is_refusing_actions = false, is_quiet = false, has_console = false;
  bool is_beside_others = false, is_open_network = false, is_check = false, has_operator = false;
  double action_delay_s = 0.2;
  std::vector<std::string> injections;
  std::string probe;                                        ///< file of what a probe can touch
  std::vector<std::string> unreferenced, failing, hanging;  ///< names of drives, or all
};

int find_drive(const char* option, const std::string& name, const MachineModel& model) {
  for (int drive = 0; drive < model.joint_count; ++drive) {
    if (drive_spec(model, drive).name == name) return drive;
  }
  throw CLI::ValidationError(option, "machine " + model.name + " has no drive " + name);
}

drives::Injection read_injection(const std::string& text, const MachineModel& model) {
  const auto injection = drives::parse_injection(text, model);
  if (!injection) throw CLI::ValidationError("--inject", injection.error());
  if (text.find('@') == std::string::npos) {
    throw CLI::ValidationError("--inject", "'" + text + "': after KIND stands @SECONDS");
  }
  return *injection;
}

std::vector<drives::HomingPlan> homing_plans(const DrivesOptions& options,
                                             const MachineModel& model) {
  std::vector<drives::HomingPlan> plans(static_cast<std::size_t>(model.joint_count));
  const auto mark = [&](const char* option, const std::vector<std::string>& names, auto change) {
    for (const std::string& name : names) {
      if (name == "all") {
        for (drives::HomingPlan& plan : plans) change(plan);
      } else {
        change(plans[static_cast<std::size_t>(find_drive(option, name, model))]);
      }
    }
  };
  mark("--unreferenced", options.unreferenced, [](auto& plan) { plan.is_referenced = false; });
  mark("--homing-fails", options.failing, [](auto& plan) { plan.fails = true; });
  mark("--homing-hangs", options.hanging, [](auto& plan) { plan.hangs = true; });
  return plans;
}

/// Whether nobody else reports a drive of the machine; says who does.
[[nodiscard]] bool is_alone(dds::Participant& participant, const MachineModel& model) {
  // Others report every few ms; the time is for finding one another.
  constexpr auto kWindow = std::chrono::milliseconds(400);
  const auto other = drive::find_other_source(participant, all_joints(model), kWindow);
  if (!other) return true;
  std::string names;
  for (int drive = 0; drive < model.joint_count; ++drive) {
    if ((other->joint_mask >> static_cast<unsigned>(drive) & 1U) == 0) continue;
    names += (names.empty() ? "" : ", ") + drive_spec(model, drive).name;
  }
  std::fprintf(
      stderr,
      "meridian drives: %s of machine %s are reported by %s already (drive group %u); end "
      "that one first, or start beside it with --beside-others, and the machine is enabled "
      "with neither\n",
      names.c_str(), model.name.c_str(), other->name.c_str(), other->group);
  return false;
}

[[nodiscard]] drives::ProbedPart read_probed_part(const std::string& name) {
  const auto text = text::read_whole(name);
  if (!text) throw CLI::ValidationError("--probe", name + ": cannot be opened");
  return drives::parse_probed_part(*text, name);
}

/// Returns the exit code.
int run_drives(const DrivesOptions& options) {
  const MachineModel model = config::load_machine(options.machine_file);
  drives::SimulatedDrivesOptions simulated;
  simulated.lag = {
      options.lag == "first" ? drives::LagKind::kFirstOrder : drives::LagKind::kSecondOrder,
      options.time_constant_ms * 1e-3};
  for (const std::string& text : options.injections) {
    simulated.injections.push_back(read_injection(text, model));
  }
  simulated.homing = homing_plans(options, model);
  if (!options.probe.empty()) simulated.probed = read_probed_part(options.probe);
  simulated.is_action_peer = !options.has_no_actions;
  simulated.is_refusing_actions = options.is_refusing_actions;
  simulated.action_delay_ns = static_cast<std::int64_t>(options.action_delay_s * 1e9);
  watch_for_stop();
  simulated.has_priority = drives::prepare_drive_priority();
  std::optional<InjectionConsole> console;
  if (options.has_console) simulated.injections_now = &console.emplace(model).injections();
  const dds::ParticipantOptions participant_options{
      .domain = options.domain,
      .machine = options.partition.empty() ? model.name : options.partition,
      .transport =
          simulated.has_priority ? dds::Transport::kLoopbackRealtime : dds::Transport::kLoopback,
      .open_network =
          options.is_open_network ? dds::OpenNetwork::kAllowed : dds::OpenNetwork::kRefused};
  if (options.is_check) {
    return check_drives(participant_options, model,
                        options.has_operator ? drives::Operator::kThere : drives::Operator::kAway);
  }
  dds::Participant participant(participant_options);
  if (participant.is_open_network()) {
    std::fprintf(stderr, "meridian drives: OPEN NETWORK: whoever reaches it may send setpoints\n");
  }
  if (!options.is_beside_others && !is_alone(participant, model)) return kMachineRefused;
  StoppableOutput output;
  // Drives wait for nobody who reads what they say, at their begin and end neither.
  drive::LineReporter lines([&](const std::string& text) { output.print(text); });
  lines.write_line(
      fmt::format("drives of machine {} in DDS domain {}: {} drives, cycle {:.3f} ms{}", model.name,
                  options.domain, model.joint_count, static_cast<double>(model.cycle_ns) * 1e-6,
                  simulated.is_action_peer ? ", answers actions" : ""));
  const auto report = drives::run_simulated_drives(participant, model, simulated, stop_flag(),
                                                   [&](const std::string& text) {
                                                     if (!options.is_quiet) lines.write_line(text);
                                                   });
  lines.write_line(fmt::format(
      "drives stopped: {} periods, {} lost, {} setpoints, {} periods bridged, {} actions",
      report.periods, report.periods_lost, report.setpoints_seen, report.periods_bridged,
      report.actions));
  for (std::size_t i = 1; i < drive::kDropKinds; ++i) {
    const auto kind = static_cast<drive::Drop>(i);
    if (report.dropped[kind] == 0) continue;
    lines.write_line(fmt::format("{} {} were dropped", report.dropped[kind], drive::name_of(kind)));
  }
  return kFine;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DrivesOptions>();
  CLI::App* command = app.add_subcommand(
      "drives",
      "Simulated drives of a machine: CiA 402 in cyclic synchronous position and homing mode, "
      "servo "
      "lag, following error, watchdog; plays the PLC that answers actions. Runs until interrupted");
  command->add_option("--machine", options->machine_file, "Machine file (TOML)")->required();
  command
      ->add_option("--machine-name", options->partition,
                   "DDS partition; default: the machine's name")
      ->check(machine_name());
  command->add_option("--domain", options->domain, "DDS domain")
      ->envname("MERIDIAN_DOMAIN")
      ->capture_default_str()
      ->check(CLI::Range(0, 230));
  command->add_option("--lag", options->lag, "Order of the servo's lag: first or second")
      ->capture_default_str()
      ->check(CLI::IsMember({"first", "second"}));
  command->add_option("--time-constant", options->time_constant_ms, "Time constant of the lag, ms")
      ->capture_default_str()
      ->check(finite_range(0.0, 1000.0));
  command->add_flag("--no-actions", options->has_no_actions, "Nobody answers actions");
  command->add_flag("--refuse-actions", options->is_refusing_actions, "Every action is refused");
  command->add_option("--action-delay", options->action_delay_s, "Time that an action takes, s")
      ->capture_default_str()
      ->check(finite_range(0.0, 3600.0));
  command->add_flag("--console", options->has_console,
                    "Read KIND[:DRIVE][=VALUE] from standard input, a line each, and let it happen "
                    "at once; 'mend' undoes everything");
  command
      ->add_option("--inject", options->injections,
                   "Something that goes wrong, KIND@SECONDS[:DRIVE][=VALUE] after operation is "
                   "enabled; may be repeated. KIND (docs/faults.md): " +
                       drives::all_injection_words())
      ->type_name("WHAT");
  const auto add_drive_names = [command](const char* name, std::vector<std::string>& names,
                                         const char* text) {
    command->add_option(name, names, text)->delimiter(',')->type_name("DRIVE,...");
  };
  command->add_flag("--beside-others", options->is_beside_others,
                    "Start though somebody else reports these drives; else that is refused");
  command->add_flag("--open-network", options->is_open_network,
                    "Start though CYCLONEDDS_URI leads off this host without an identity; else "
                    "that is refused");
  add_drive_names("--unreferenced", options->unreferenced,
                  "Drives (or all) that do not know where they are until they are homed");
  add_drive_names("--homing-fails", options->failing,
                  "Drives (or all) that say that they found no reference");
  add_drive_names("--homing-hangs", options->hanging,
                  "Drives (or all) that search for their reference for ever");
  command
      ->add_option("--probe", options->probe,
                   "A touch probe is in the spindle: file (TOML) of its stylus and of what it "
                   "can touch")
      ->type_name("FILE");
  CLI::Option* const check = command->add_flag(
      "--check", options->is_check,
      "Check somebody's drives, which run already, instead: play the service against "
      "them and name the rules that they break. The first linear drive moves by some "
      "centimetres");
  command
      ->add_flag("--emergency-stop", options->has_operator,
                 "With --check: you open and close the emergency stop when it says so")
      ->needs(check);
  command->add_flag("-q,--quiet", options->is_quiet, "Say only begin and end");
  command->callback([options, &exit_code] { exit_code = run_drives(*options); });
}

}  // namespace meridian::cli::drives_command
