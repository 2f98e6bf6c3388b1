// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/options/cl_options.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/machine/inspect/joint_pattern.hpp"
#include "service/machine/inspect/machine_picture.hpp"
#include "service/machine/inspect/path_picture.hpp"
#include "service/machine/inspect/placing.hpp"
#include "service/machine/inspect/program_poses.hpp"
#include "service/machine/inspect/rotary_centres.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli::machine_command {
namespace {

struct Options {
  MachineOptions machine;
  ClFileOptions cl;
  std::string picture, along, pattern, program, box, touches, written;
  std::optional<double> sphere_radius_mm;
  bool may_turn = false;
};

int refuse(const std::string& message) {
  std::cerr << "meridian machine: " << message << "\n";
  return kInputRefused;
}

/// `x0,x1,y0,y1,z0,z1` in mm; throws config::ConfigError.
inspect::PlacingBox read_box(const std::string& text) {
  inspect::PlacingBox box;
  std::istringstream numbers(text);
  bool is_fine = true;
  for (std::size_t i = 0; i < 3 && is_fine; ++i) {
    char comma = ',';
    if (i > 0) numbers >> comma;
    is_fine = comma == ',' && (numbers >> box.low_mm[i] >> comma >> box.high_mm[i]) &&
              comma == ',' && box.low_mm[i] <= box.high_mm[i];
  }
  if (is_fine && numbers.peek() == std::istringstream::traits_type::eof()) return box;
  throw config::ConfigError({.file = "--box",
                             .value = "'" + text + "' is no box",
                             .remedy = "give x0,x1,y0,y1,z0,z1 in mm, the smaller of each first"});
}

/// Every pose of a program; throws config::ConfigError.
Expected<std::vector<inspect::ProgramPose>, std::string> read_program(const Options& options,
                                                                      const std::string& name,
                                                                      const MachineModel& model) {
  ToolTable tools = load_tools(options.machine);
  cl::ClReaderOptions reading = reader_options(options.cl, options.machine, model);
  add_unknown_tools(name, reading, options.machine, tools);
  describe_machine(reading, model, tools, load_tool_names(options.machine));
  std::ifstream file;
  std::istream* const input = open_cl_file(name, file);
  if (input == nullptr) return tl::make_unexpected(name + ": cannot be opened");
  cl::ClReader reader(*input, name, reading);
  auto poses = inspect::read_poses(reader, model, tools);
  if (!poses) return tl::make_unexpected(poses.error().text());
  if (poses->empty()) return tl::make_unexpected(name + " moves nothing");
  return *std::move(poses);
}

/// Looks for a frame in which the whole program fits.
int place(const Options& options, const MachineModel& model) {
  const auto poses = read_program(options, options.program, model);
  if (!poses) return refuse(poses.error());
  inspect::PlacingBox box =
      options.box.empty() ? inspect::widest_box(model, *poses) : read_box(options.box);
  box.may_turn = options.may_turn;
  const inspect::Placing found = inspect::find_placing(model, *poses, box);
  std::cout << to_text(found, model);
  return found.fit.margin >= 0 ? kFine : kVerdictNo;
}

/// The picture of the machine at places of a program.
int draw_along(const Options& options, const MachineModel& model) {
  constexpr int kPlaces = 9;
  const auto poses = read_program(options, options.along, model);
  if (!poses) return refuse(poses.error());
  const auto postures = inspect::postures_along(model, *poses, kPlaces);
  if (!postures) return refuse(options.along + ": " + postures.error());
  const auto error = inspect::draw_along(model, *postures, options.picture);
  return error ? refuse(*error) : kFine;
}

[[nodiscard]] std::optional<std::string> text_of(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

/// Where the rotary axes lie by touches of a sphere; into a new machine file where all is known.
int calibrate(const Options& options, const MachineModel& model) {
  const auto text = text_of(options.touches);
  if (!text) return refuse(options.touches + ": cannot be opened");
  const auto touches = inspect::read_touches(*text, options.touches);
  if (!touches) return refuse(touches.error());
  const auto found = inspect::find_rotary_centres(model, *touches, options.sphere_radius_mm);
  if (!found) return refuse(options.touches + ": " + found.error());
  std::cout << to_text(*found);
  if (options.written.empty()) return found->is_determined() ? kFine : kVerdictNo;
  const std::string machine_file = text_of(options.machine.machine).value_or("");
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
  if (!options.program.empty()) return place(options, model);
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
  CLI::Option* const program = command->add_option(
      "--place", options->program,
      "A part program: find the frame in which it fits with the largest margin to all ends of "
      "travel. Exit code 1 where there is none");
  command
      ->add_option(
          "--box", options->box,
          "With --place: where the origin of the workpiece may lie, x0,x1,y0,y1,z0,z1 in mm; "
          "default: wherever the machine reaches")
      ->needs(program);
  command->add_flag("--turn", options->may_turn, "With --place: the workpiece may turn about z")
      ->needs(program);
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
