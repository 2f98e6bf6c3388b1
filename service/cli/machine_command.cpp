// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/machine_options.hpp"
#include "service/inspect/inspection.hpp"
#include "service/inspect/joint_pattern.hpp"
#include "service/inspect/machine_picture.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli {
namespace {

struct Options {
  MachineOptions machine;
  std::string picture, pattern;
};

int refuse(const std::string& message) {
  std::cerr << "meridian machine: " << message << "\n";
  return kInputRefused;
}

int run(const Options& options) {
  const std::string lost =
      text::refusal_to_write({options.machine.machine}, {options.picture, options.pattern});
  if (!lost.empty()) return refuse(lost);
  const MachineModel model = load_machine(options.machine);
  const inspect::Inspection inspection = inspect::inspect(model);
  std::cout << to_text(inspection, model);
  if (!options.picture.empty()) {
    const auto error = inspect::draw(model, inspection.skeleton, options.picture);
    if (error) return refuse(*error);
  }
  if (!options.pattern.empty()) {
    text::WholeFile pattern(options.pattern);
    inspect::write_joint_pattern(model, pattern.out());
    if (!pattern.commit()) return refuse(options.pattern + " cannot be written");
  }
  return inspection.warnings.empty() ? kFine : kVerdictNo;
}

}  // namespace

void add_machine_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "machine",
      "A machine file looked at before anything moves: chain, home, what each joint alone does to "
      "the tool, poles, reach, limits, what looks like a slip. Exit code 1 where there is a "
      "warning");
  command->add_option("file", options->machine.machine, "Machine file (TOML)")->required();
  command->add_option("--frame", options->machine.frame,
                      "Where the workpiece lies: x,y,z[,a,b,c] in mm and deg, Rz(c) Ry(b) Rx(a); "
                      "instead of the machine file's frame");
  command->add_option("--picture", options->picture,
                      "Draw axes, pivots, tool and workpiece in three views to this .png or .svg");
  command->add_option("--pattern", options->pattern,
                      "Write a CL file that moves each joint alone, forwards and back");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli
