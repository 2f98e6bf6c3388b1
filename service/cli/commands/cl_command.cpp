// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "service/cli/commands.hpp"
#include "service/cli/options/cl_options.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/programs/cl/interpreter/run_cl.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cli::cl_command {
namespace {

/// The options of the reader; poses come out in the frame around the workpiece.
cl::ClReaderOptions reading(const std::string& program, const ClFileOptions& file,
                            MachineOptions machine) {
  if (machine.machine.empty()) return reader_options(file);
  machine.frame = file.frame;
  const MachineModel model = load_machine(machine);
  cl::ClReaderOptions out = reader_options(file, machine, model);
  ToolTable tools = load_tools(machine);
  describe_machine(out, model, tools, load_tool_names(machine));
  add_unknown_tools(program, out, machine, tools);
  describe_machine(out, model, tools, load_tool_names(machine));
  if (out.frame) {
    out.home = [home = out.home, frame = *out.frame](std::optional<std::uint32_t> tool) {
      std::optional<ToolPose> pose = home(tool);
      if (pose) pose = ToolPose{frame.point(pose->tip), frame.direction(pose->axis)};
      return pose;
    };
  }
  return out;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  struct Options {
    cl::RunOptions run;
    ClFileOptions file;
    MachineOptions machine;
    bool is_summary = false, is_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "cl",
      "A CL file or NC program as plain points, one `x y z i j k feed` a line (mm, mm/min; feed of "
      "the block "
      "that ends there, 0 for rapid; arcs as chords), or a summary of what was read");
  add_cl_file(*command, options->run.file);
  command->add_option("-o,--output", options->run.output, "Write to this file");
  command->add_flag("-s,--summary", options->is_summary, "Report what was read, no points");
  command->add_flag("--json", options->is_json,
                    "Summary and everything that was found in the file, as JSON");
  command
      ->add_flag_callback(
          "--words",
          [] {
            std::cout << cl::words_text();
            throw CLI::Success();
          },
          "Print the table of words that the reader knows, and end")
      ->trigger_on_parse();
  command
      ->add_option("--chord-error", options->run.chord_error_mm,
                   "How far chords may lie from their arc, mm")
      ->capture_default_str()
      ->check(finite_range(1e-6, 1.0));
  CLI::Option* const machine = command->add_option(
      "-m,--machine", options->machine.machine,
      "Machine file (TOML): what rotary words of NC programs turn, and where GOHOME leads");
  command
      ->add_option("--tools", options->machine.tools,
                   "Tool table (TOML): lengths for moves to the machine's own places")
      ->needs(machine);
  add_unknown_tool_option(*command, options->machine)->needs(machine);
  add_cl_file_options(*command, options->file);
  add_frame_option(*command, options->file);
  command->callback([options, &exit_code] {
    options->run.reader = reading(options->run.file, options->file, options->machine);
    if (options->is_summary) options->run.what = cl::RunOptions::Output::kSummary;
    if (options->is_json) options->run.what = cl::RunOptions::Output::kJson;
    exit_code = cl::run_cl(options->run, std::cout, std::cerr);
  });
}

}  // namespace meridian::cli::cl_command
