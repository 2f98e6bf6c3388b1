// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/host/process/claimed_domain.hpp"
#include "service/host/process/programs.hpp"
#include "service/host/soak/report/report_files.hpp"
#include "service/host/soak/soak.hpp"
#include "service/machine/file/sections/service_file.hpp"

namespace meridian::cli::soak_command {
namespace {

struct Options {
  soak::SoakOptions soak;
  std::optional<std::uint32_t> domain;
  std::string duration = "60s", report;
  bool is_json = false;
};

/// "90", "90s", "15m", "8h" in seconds; throws CLI::ValidationError.
[[nodiscard]] double seconds_of(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  if (!(number > 0) || !std::isfinite(number) || factor == 0) {
    throw CLI::ValidationError("--for", "'" + text + "' is no time: 90s, 15m, 8h");
  }
  return number * factor;
}

int run(Options& options) {
  options.soak.for_s = seconds_of(options.duration);
  options.soak.report = options.report;
  if (!options.soak.service.empty()) {
    const config::ServiceConfig service = config::load_service(options.soak.service);
    if (options.soak.machine.empty()) options.soak.machine = service.machine.string();
    if (options.soak.tools.empty()) options.soak.tools = service.tools.string();
  }
  if (options.soak.machine.empty()) {
    options.soak.machine = process::shipped_file("machines/lai.toml").string();
  }
  std::vector<std::string> read = options.soak.programs;
  read.insert(read.end(), {options.soak.machine, options.soak.tools, options.soak.service});
  if (const auto refusal = soak::refusal_to_report(options.report, read); !refusal.empty()) {
    throw CLI::ValidationError("--report", refusal);
  }
  std::optional<process::ClaimedDomain> claimed;
  if (!options.domain) claimed.emplace(process::kFirstProbeDomain, process::kLastProbeDomain);
  options.soak.domain = options.domain ? *options.domain : claimed->id();
  watch_for_stop();
  outlive_readers();
  const soak::SoakReport report =
      soak::run_soak(options.soak, stop_flag(),
                     [](const std::string& text) { std::cerr << "soak: " << text << "\n"; });
  std::cout << (options.is_json ? to_json(report) : to_text(report));
  return report.passed() ? kFine : kVerdictNo;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command =
      app.add_subcommand("soak",
                         "Service, simulated drives and station run for long, with mishaps on a "
                         "seeded schedule; every "
                         "setpoint is checked while it runs. Exit code 1 where anything was wrong");
  command->add_option("programs", options->soak.programs,
                      "CL files to cut, one after the other; default: drawn ones near home");
  command->add_option("--for", options->duration, "How long: 90s, 15m, 8h")->capture_default_str();
  command->add_option("--machine", options->soak.machine,
                      "Machine file (TOML); default: that of --service, else the Lai machine that "
                      "is shipped");
  command->add_option("--tools", options->soak.tools,
                      "Tool table (TOML); default: that of --service");
  command->add_option("--service", options->soak.service,
                      "Service file (TOML) of the service that will serve here: its machine, "
                      "tools, processor, priorities, rights and bridge are run, enforced where it "
                      "says so; default: best effort, on the last processor");
  command->add_option("--trace", options->soak.trace,
                      "Folder in which the service leaves traces of the worst cycles "
                      "(docs/realtime.md)");
  command
      ->add_option("--chaos", options->soak.chaos_every_s,
                   "Mishaps every so many seconds on the average: hold, override, abort, a station "
                   "or service that dies, drives that fail; default: none")
      ->check(finite_range(0.5, 1e6));
  command->add_option("--seed", options->soak.seed, "Of programs and mishaps")
      ->capture_default_str();
  command
      ->add_option("--domain", options->domain,
                   "DDS domain, which must be free; default: one from 221 to 230 that no other "
                   "soak or probe of this host has")
      ->check(CLI::Range(0, 230));
  command->add_option("--report", options->report,
                      "JSON file, written again and again while it runs, so not called .txt: the "
                      "text lies beside it as .txt, recordings with something wrong in a folder "
                      "as .kept");
  command->add_flag("--json", options->is_json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::soak_command
