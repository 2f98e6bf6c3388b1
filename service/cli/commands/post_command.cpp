// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "meridian/units.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/post/post.hpp"
#include "service/programs/post/tip_frame.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli::post_command {
namespace {

struct Options {
  std::string file, output, dialect = "joints";
  std::optional<double> axis_deg, rapid_feed_mm_per_min;
  std::vector<std::string> zeros;
  post::PostOptions post;
  MachineOptions machine;
  ClFileOptions cl;
};

int refuse(const std::string& message) {
  std::cerr << message << "\n";
  return kInputRefused;
}

const std::map<std::string, post::Dialect>& dialects() {
  static const std::map<std::string, post::Dialect> all = {
      {"joints", post::Dialect::kJoints},   {"fanuc", post::Dialect::kFanuc},
      {"siemens", post::Dialect::kSiemens}, {"heidenhain", post::Dialect::kHeidenhain},
      {"krl", post::Dialect::kKrl},         {"rapid", post::Dialect::kRapid},
      {"ls", post::Dialect::kLs},           {"urscript", post::Dialect::kUrScript}};
  return all;
}

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const auto& [name, dialect] : dialects()) names.push_back(name);
  return names;
}

int run(Options options) {
  const MachineModel model = load_machine(options.machine);
  ToolTable tools = load_tools(options.machine);
  options.post.dialect = dialects().at(options.dialect);
  for (const std::string& zero : options.zeros) {  // "J2=-90", checked by the command line
    options.post.zero_deg[static_cast<std::size_t>(zero[1] - '1')] = std::stod(zero.substr(3));
  }
  if (options.post.is_forearm_coupled && options.post.dialect != post::Dialect::kLs) {
    return refuse("--coupled is of FANUC's robots: give it with --dialect ls");
  }
  if (!post::is_robot_language(options.post.dialect) &&
      (!options.zeros.empty() || !options.post.program_name.empty())) {
    return refuse("--zero and --program-name are of robots' languages: krl, rapid, ls, urscript");
  }
  if (options.axis_deg) options.post.axis_rad = units::rad_from_deg(*options.axis_deg);
  if (options.rapid_feed_mm_per_min) {
    options.post.rapid_feed_mm_per_s = units::per_s_from_per_min(*options.rapid_feed_mm_per_min);
  }
  const std::string lost = text::refusal_to_write(
      {options.file, options.machine.machine, options.machine.tools}, {options.output});
  if (!lost.empty()) return refuse(lost);
  std::ifstream file;
  std::istream* const input = open_cl_file(options.file, file);
  if (input == nullptr) return refuse(options.file + ": cannot be opened");
  cl::ClReaderOptions reading = reader_options(options.cl, options.machine, model);
  if (!pass_file(options.file, reading, options.machine, model, tools)) return kInputRefused;
  cl::ClReader reader(*input, options.file, reading);
  const auto program = post::write_nc(reader, options.file, model, tools, options.post);
  if (!can_be_read_twice(options.file)) print_warnings(options.file, reader.warnings());
  if (!program) {
    const post::PostError& error = program.error();
    return refuse(options.file + (error.line > 0 ? ":" + std::to_string(error.line) : "") + ": " +
                  error.message);
  }
  if (program->feeds_limited > 0) {
    std::cerr << options.file << ": warning: " << program->feeds_limited
              << " feeds above the machine's highest were limited to it\n";
  }
  const bool has_tip_words = !post::is_robot_language(options.post.dialect) &&
                             options.post.dialect != post::Dialect::kJoints;
  if (has_tip_words && !post::is_spindle_along_z(model)) {
    std::cerr << options.machine.machine
              << ": warning: with its rotary joints at zero the spindle does not stand along +Z; "
                 "the program is right only on a control that counts so\n";
  }
  if (options.output.empty()) {
    std::cout << program->text << std::flush;
    return std::cout ? kFine : refuse("meridian post: the output cannot be written");
  }
  if (!text::write_whole(options.output, program->text)) {
    return refuse(options.output + ": cannot be written");
  }
  std::cout << options.output << ": " << program->motion_blocks << " CL motions, "
            << program->blocks << " NC blocks\n";
  return kFine;
}

/// A check that a word of the machine's own looks like one.
CLI::Validator matches(const char* pattern, const char* description) {
  return {[pattern, description](std::string& text) {
            return std::regex_match(text, std::regex(pattern))
                       ? std::string()
                       : std::string("is not ") + description;
          },
          description};
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "post",
      "Write the NC program of a CL file. Poles and ways between blocks as the service has them "
      "from rest to rest; begins on the branch and winding that carry farthest; what cannot be "
      "expressed is refused with its line, and nothing is written then (docs/postprocessor.md)");
  add_cl_file(*command, options->file);
  add_machine_options(*command, options->machine, true);
  command->add_option("-o,--output", options->output, "Write to this file; else standard output");
  command
      ->add_option("--dialect", options->dialect,
                   "joints: joint words and feed in inverse time, for controllers without "
                   "tool-centre control; fanuc: G43.4; siemens: TRAORI; heidenhain: FUNCTION TCPM; "
                   "robots: krl (KUKA), rapid (ABB), ls (FANUC), urscript (Universal Robots)")
      ->check(CLI::IsMember(dialect_names()))
      ->capture_default_str();
  command
      ->add_option("--chord-mm", options->post.chord_mm,
                   "How far the tip may leave its path between two NC blocks; else tip_mm of the "
                   "machine's tolerances")
      ->check(finite_range(1e-4, 10.0));
  command
      ->add_option("--axis-deg", options->axis_deg,
                   "How far the tool axis may; else axis_deg of the machine's tolerances")
      ->check(finite_range(1e-4, 10.0));
  command
      ->add_option("--rapid-feed", options->rapid_feed_mm_per_min,
                   "Write rapids as cuts at this feed, mm/min, for controllers whose G0 is not "
                   "straight")
      ->check(finite_range(1.0, 1e6));
  command->add_option("--work-offset", options->post.work_offset, "Work offset in force")
      ->check(matches("G5[4-9](\\.1 ?P[0-9]{1,3})?", "G54 to G59 or G54.1 Pn"))
      ->capture_default_str();
  command
      ->add_option("--retract", options->post.retract,
                   "The machine's own block that takes the tool clear of the part, such as "
                   "\"G53 G0 Z0\"")
      ->check(matches("[A-Z0-9 .,=+-]{2,60}", "one NC block"));
  command
      ->add_option("--through-coolant", options->post.through_coolant,
                   "The machine's word for coolant through the tool, such as M88")
      ->check(matches("M[0-9]{1,3}", "an M word"));
  command->add_flag("--vector", options->post.has_vectors,
                    "fanuc: G43.5 and I J K instead of G43.4 and rotary words");
  command
      ->add_option("--offset-number", options->post.offset_number,
                   "fanuc: H of the tool in the spindle, for programs that call none")
      ->check(CLI::Range(1, 9999));
  command
      ->add_option("--program-number", options->post.program_number,
                   "fanuc: O word; without it none is written")
      ->check(CLI::Range(1, 99999999));
  command->add_option("--program-name", options->post.program_name,
                      "Robots: name of the program; else made from the CL file's");
  command
      ->add_option("--zero", options->zeros,
                   "Robots: what the controller shows for an axis whose joint is at zero, degrees, "
                   "such as J2=-90; once for each axis")
      ->check(matches("J[1-6]=-?[0-9]{1,3}([.][0-9]{1,5})?", "an axis and degrees, as J2=-90"));
  command->add_flag("--coupled", options->post.is_forearm_coupled,
                    "ls: J3 counts from the horizontal, as most FANUC robots show it: joints two "
                    "and three together");
  command->add_flag("--line-words", options->post.has_line_words,
                    "N words: the line of the CL file that a block comes from");
  add_cl_file_options(*command, options->cl, "--cl-dialect");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::post_command
