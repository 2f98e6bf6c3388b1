// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "meridian/units.hpp"
#include "service/analysis/bench/bench_paths.hpp"
#include "service/analysis/bench/bench_run.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/host/process/programs.hpp"

namespace meridian::cli::bench_command {
namespace {

struct Options {
  std::vector<std::string> paths;
  MachineOptions machine;
  std::string folder, pole_policy = "both";
  double feed_mm_per_min = units::per_min_from_per_s(bench::kFeed_mm_per_s);
  double override_ramp_s = 0;
  bool is_certified = false;
};

int refuse(const std::string& message) {
  std::cerr << "meridian bench: " << message << "\n";
  return kInputRefused;
}

int run_all(const Options& options, const std::string& folder) {
  MachineModel model = load_machine(options.machine);
  if (options.override_ramp_s > 0) model.override_ramp_s = options.override_ramp_s;
  const bench::BenchOptions bench{units::per_s_from_per_min(options.feed_mm_per_min), folder,
                                  options.is_certified};
  std::cout << bench::table_header();
  bool is_in_order = true;
  for (const std::string& name : options.paths.empty() ? bench::path_names() : options.paths) {
    for (const PolePolicy policy : {PolePolicy::kRelax, PolePolicy::kExact}) {
      const char* const word = policy == PolePolicy::kRelax ? "ease" : "exact";
      if (options.pole_policy != "both" && options.pole_policy != word) continue;
      model.pole_policy = policy;
      const auto result = bench::run_path(name, model, bench);
      if (!result) return refuse(result.error());
      std::cout << bench::table_row(*result) << std::flush;
      is_in_order &= result->is_in_order();
    }
  }
  return is_in_order ? kFine : kVerdictNo;
}

int run(const Options& options) {
  if (options.folder.empty()) {
    const process::ScratchFolder scratch;
    return run_all(options, scratch.path().string());
  }
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) return refuse(options.folder + ": " + error.message());
  return run_all(options, options.folder);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "bench",
      "Benchmark paths, smooth, through planner and cycle as the service runs them: time, and how "
      "the recording stands to every limit and tolerance. Exit code 1 where one is not kept");
  command->add_option("path", options->paths, "Which of them; else all")
      ->check(CLI::IsMember(bench::path_names()));
  add_machine_options(*command, options->machine, true);
  command->add_option(
      "-o,--write", options->folder,
      "Keep CL files and recordings in this folder, for other controls and checkers");
  command
      ->add_option("--pole-policy", options->pole_policy,
                   "ease (inside the axis tolerance), exact, or both")
      ->check(CLI::IsMember({"ease", "exact", "both"}))
      ->capture_default_str();
  command->add_option("--feed", options->feed_mm_per_min, "Of all paths, mm/min")
      ->check(finite_range(1.0, 1e6))
      ->capture_default_str();
  command
      ->add_option(
          "--override-ramp-s", options->override_ramp_s,
          "Instead of the machine file's: time of the override from 100 % to 0; 1000 keeps "
          "next to nothing for it")
      ->check(finite_range(1.0, 1000.0));
  command->add_flag("--certify", options->is_certified,
                    "Prove that each plan keeps every limit between its setpoints too");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::bench_command
