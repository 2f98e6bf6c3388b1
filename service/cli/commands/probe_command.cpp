// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/cli/commands.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/host/probe/probe_report.hpp"
#include "service/host/probe/run/bare_peer.hpp"
#include "service/host/probe/run/load.hpp"
#include "service/host/process/claimed_domain.hpp"
#include "service/host/process/programs.hpp"
#include "service/machine/file/sections/service_file.hpp"

namespace meridian::cli::probe_command {
namespace {

struct Options {
  probe::MeasureOptions measure;
  std::optional<std::uint32_t> domain;
  std::optional<int> cpu;
  std::string service, picture;
  std::vector<std::string> bare_peer;
  int burner = -1;
  bool is_json = false, is_target = false;
};

int be_bare_peer(const std::vector<std::string>& words) {
  probe::run_bare_peer({.cpu = std::stoi(words[0]),
                        .domain = static_cast<std::uint32_t>(std::stoul(words[1])),
                        .period_ns = std::stoll(words[2]),
                        .partition = words[3],
                        .priority = std::stoi(words[4])});
  return kFine;
}

/// What the service file says, and on top of it what the command line says.
void take_service(Options& options) {
  if (!options.service.empty()) {
    const config::ServiceConfig service = config::load_service(options.service);
    options.measure.realtime = service.realtime;
    if (options.measure.machine.empty()) options.measure.machine = service.machine.string();
  }
  if (options.cpu) options.measure.realtime.cpu = *options.cpu;
  if (options.measure.machine.empty()) {
    options.measure.machine = process::shipped_file("machines/lai.toml").string();
  }
}

/// Prints and draws. A picture that cannot be drawn is reported; the exit code is the verdict's.
int print_report(const Options& options, const probe::ProbeReport& report) {
  std::cout << (options.is_json ? to_json(report) : to_text(report)) << std::flush;
  if (!options.picture.empty()) {
    if (const auto error = draw(report, options.picture)) std::cerr << error->text() << "\n";
  }
  return report.is_fit() ? kFine : kVerdictNo;
}

int run(Options& options) {
  if (!options.bare_peer.empty()) return be_bare_peer(options.bare_peer);
  if (options.burner >= 0) probe::burn(options.burner);
  take_service(options);
  if (const std::string refusal = probe::too_large(options.measure, probe::available_mib());
      !refusal.empty()) {
    throw CLI::ValidationError("--for", refusal);
  }
  std::optional<process::ClaimedDomain> claimed;
  if (!options.domain) claimed.emplace(process::kFirstProbeDomain, process::kLastProbeDomain);
  options.measure.domain = options.domain ? *options.domain : claimed->id();
  outlive_readers();
  watch_for_stop();
  probe::ProbeReport report;
  report.host = probe::host_text();
  report.is_target = options.is_target;
  report.cpu = probe::cycle_cpu(options.measure.realtime);
  report.missing_rights = probe::missing_rights(probe::try_rights(), options.measure.realtime);
  try {
    probe::measure(options.measure, stop_flag(),
                   {[](const std::string& text) { std::cerr << "probe: " << text << "\n"; },
                    [&](const probe::RateMeasurement& one) { report.add(one); }});
    const std::size_t wanted = options.measure.rates_hz.size() * (options.measure.has_load ? 2 : 1);
    if (report.measurements.size() < wanted) report.broken_off = "interrupted";
  } catch (const std::exception& error) {
    if (report.measurements.empty()) throw;
    report.broken_off = error.what();
  }
  return print_report(options, report);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "probe",
      "What this host can do: lateness, computation and transport of the service, in turns with a "
      "bare thread and a bare DDS ping, against the budgets. Exit code 1 where one is missed or "
      "unknown. Interrupted it reports what there is");
  command->add_option("--machine", options->measure.machine,
                      "Machine file (TOML); default: that of --service, else the Lai machine that "
                      "is shipped");
  command->add_option("--service", options->service,
                      "Service file (TOML) of the service that will serve here: its processor, "
                      "priorities and rights are measured, and its machine");
  command
      ->add_option("--cpu", options->cpu,
                   "Processor of the cycle; default: as --service says, else the last that this "
                   "process may use. One that is isolated has to be named by either")
      ->check(CLI::Range(0, 1023));
  command
      ->add_option("--rates", options->measure.rates_hz,
                   "Cycles per second, one or several: 1000,2000,4000,8000")
      ->delimiter(',')
      ->check(CLI::Range(250, 8000))
      ->capture_default_str();
  command
      ->add_option("--for", options->measure.turns,
                   "How long each of service, bare thread, bare ping and program runs, s")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command->add_flag("--load", options->measure.has_load,
                    "Once more while every processor copies memory and writes files");
  command->add_flag("--target", options->is_target,
                    "Budgets and rights of a target host decide too; without, they are only shown");
  command
      ->add_option("--domain", options->domain,
                   "DDS domain, which must be free; default: one from 221 to 230 that no other "
                   "soak or probe of this host has")
      ->check(CLI::Range(0, 230));
  command->add_flag("--json", options->is_json, "As JSON");
  command->add_option("--picture", options->picture, "Draw the distributions to this .png or .svg");
  command->add_option("--bare-peer", options->bare_peer)->expected(5)->group("");
  command->add_option("--burn", options->burner)->group("");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::probe_command
