// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/options/cl_options.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/placing_options.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/calibrate/rotary_centres.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/machine/inspect/joint_pattern.hpp"
#include "service/machine/inspect/picture/machine_picture.hpp"
#include "service/machine/inspect/picture/path_picture.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli::machine_command {
namespace {

struct Options {
  MachineOptions machine;
  ClFileOptions cl;
  PlacingOptions placing;
  std::string picture, along, pattern, touches, written;
  std::optional<double> sphere_radius_mm;
};

int refuse(const std::string& message) {
  std::cerr << "meridian machine: " << message << "\n";
  return kInputRefused;
}

/// The picture of the machine at points of a program.
int draw_along(const Options& options, const MachineModel& model) {
  constexpr int kSamples = 9;
  const auto poses = read_program_poses(options.along, options.cl, options.machine, model);
  if (!poses) return refuse(poses.error());
  const auto postures = inspect::postures_along(model, *poses, kSamples);
  if (!postures) return refuse(options.along + ": " + postures.error());
  const auto error = inspect::draw_along(model, *postures, options.picture);
  return error ? refuse(*error) : kFine;
}

/// Where the rotary axes lie by touches of a sphere; into a new machine file where all is known.
int calibrate(const Options& options, const MachineModel& model) {
  const auto text = text::read_whole(options.touches);
  if (!text) return refuse(options.touches + ": cannot be opened");
  const auto touches = inspect::read_touches(*text, options.touches);
  if (!touches) return refuse(touches.error());
  const auto found = inspect::find_rotary_centres(model, *touches, options.sphere_radius_mm);
  if (!found) return refuse(options.touches + ": " + found.error());
  std::cout << to_text(*found);
  if (options.written.empty()) return found->is_determined() ? kFine : kVerdictNo;
  const std::string machine_file = text::read_whole(options.machine.machine).value_or("");
  const auto written = inspect::with_centres(machine_file, *found);
  if (!written) return refuse(options.machine.machine + ": " + written.error());
  (void)config::parse_machine(*written, options.written);
  if (!text::write_whole(options.written, *written)) {
    return refuse(options.written + " cannot be written");
  }
  return found->is_determined() ? kFine : kVerdictNo;
}

int run(const Options& options) {
  const std::string lost =
      text::refusal_to_write({options.machine.machine, options.touches, options.along},
                             {options.picture, options.pattern, options.written});
  if (!lost.empty()) return refuse(lost);
  const MachineModel model = load_machine(options.machine);
  if (!options.placing.program.empty()) {
    const auto code = run_placing(options.placing, options.cl, options.machine, model);
    return code ? *code : refuse(code.error());
  }
  if (!options.touches.empty()) return calibrate(options, model);
  if (!options.along.empty()) return draw_along(options, model);
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

void add(CLI::App& app, int& exit_code) {
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
  CLI::Option* const picture = command->add_option(
      "--picture", options->picture,
      "Draw axes, pivots, tool and workpiece in three views to this .png or .svg");
  command
      ->add_option("--along", options->along,
                   "With --picture: a part program; draw the arm, or slides and rods, where they "
                   "stand at up to nine places of it")
      ->needs(picture);
  command->add_option("--pattern", options->pattern,
                      "Write a CL file that moves each joint alone, forwards and back");
  CLI::Option* const program = add_placing_options(*command, options->placing);
  command->add_option("--tools", options->machine.tools,
                      "With --place or --along: tool table (TOML)");
  command
      ->add_option("--unknown-tool-length", options->machine.unknown_tool_length_mm,
                   "With --place or --along: length of tools that the table has not, mm")
      ->check(finite_range(0.0, 1e4));
  CLI::Option* const touches =
      command->add_option("--calibrate", options->touches,
                          "Touches of a sphere on the table (ctl touch-off touch): find where the "
                          "rotary axes lie. Exit "
                          "code 1 where the touches do not determine all of it");
  touches->excludes(program);
  command
      ->add_option("--write", options->written,
                   "With --calibrate: a new machine file with what was found")
      ->needs(touches);
  command
      ->add_option("--sphere-radius", options->sphere_radius_mm,
                   "With --calibrate: radius of the sphere, mm; default: found as well")
      ->needs(touches)
      ->check(finite_range(1e-3, 1e4));
  add_cl_file_options(*command, options->cl);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::machine_command
