// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/cli/commands.hpp"
#include "service/cli/peer_options.hpp"
#include "service/probe/bare_peer.hpp"
#include "service/probe/probe_report.hpp"
#include "service/process/claimed_domain.hpp"
#include "service/process/programs.hpp"

namespace meridian::cli {
namespace {

struct Options {
  probe::MeasureOptions measure;
  std::optional<std::uint32_t> domain;
  std::string picture;
  std::vector<std::string> bare_peer;
  bool is_json = false, is_target = false;
};

int be_bare_peer(const std::vector<std::string>& words) {
  probe::run_bare_peer({.cpu = std::stoi(words[0]),
                        .domain = static_cast<std::uint32_t>(std::stoul(words[1])),
                        .period_ns = std::stoll(words[2]),
                        .partition = words[3]});
  return kFine;
}

int run(Options& options) {
  if (!options.bare_peer.empty()) return be_bare_peer(options.bare_peer);
  if (options.measure.machine.empty()) {
    options.measure.machine = process::shipped_file("machines/lai.toml").string();
  }
  if (const std::string refusal = probe::too_large(options.measure, probe::available_mib());
      !refusal.empty()) {
    throw CLI::ValidationError("--for", refusal);
  }
  std::optional<process::ClaimedDomain> claimed;
  if (!options.domain) claimed.emplace(process::kFirstProbeDomain, process::kLastProbeDomain);
  options.measure.domain = options.domain ? *options.domain : claimed->id();
  outlive_readers();
  probe::ProbeReport report;
  report.host = probe::host_text();
  report.is_target = options.is_target;
  report.measurements = probe::measure(
      options.measure, [](const std::string& text) { std::cerr << "probe: " << text << "\n"; });
  for (const probe::RateMeasurement& one : report.measurements) {
    const auto verdicts = probe::judge(one);
    report.verdicts.insert(report.verdicts.end(), verdicts.begin(), verdicts.end());
  }
  std::cout << (options.is_json ? to_json(report) : to_text(report));
  if (!options.picture.empty()) {
    if (const auto error = draw(report, options.picture)) {
      std::cerr << error->text() << "\n";
      return kInputRefused;
    }
  }
  return report.is_fit() ? kFine : kVerdictNo;
}

}  // namespace

void add_probe_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "probe",
      "What this host can do: lateness, computation and transport of the service, in turns with a "
      "bare thread and a bare DDS ping, against the budgets. Exit code 1 where one is missed");
  command->add_option("--machine", options->measure.machine,
                      "Machine file (TOML); default: the Lai machine that is shipped");
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
                    "Budgets of a target host decide too; without, they are only told");
  command
      ->add_option("--domain", options->domain,
                   "DDS domain, which must be free; default: one from 221 to 230 that no other "
                   "soak or probe of this host has")
      ->check(CLI::Range(0, 230));
  command->add_flag("--json", options->is_json, "As JSON");
  command->add_option("--picture", options->picture, "Draw the distributions to this .png or .svg");
  command->add_option("--bare-peer", options->bare_peer)->expected(4)->group("");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli
