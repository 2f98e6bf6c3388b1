// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "service/cl/run_cl.hpp"
#include "service/cl/words/word_table.hpp"
#include "service/cli/cl_options.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/finite_range.hpp"

namespace meridian::cli {

void add_cl_command(CLI::App& app, int& exit_code) {
  struct Options {
    cl::RunOptions run;
    ClFileOptions file;
    bool is_summary = false, is_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "cl",
      "A CL file as plain points, one `x y z i j k feed` a line (mm, mm/min; feed of the block "
      "that ends there, 0 for rapid; arcs as chords), or a summary of what was read");
  add_cl_file(*command, options->run.file);
  command->add_option("-o,--output", options->run.output, "Write to this file");
  command->add_flag("-s,--summary", options->is_summary, "Tell what was read, no points");
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
  add_cl_file_options(*command, options->file);
  add_frame_option(*command, options->file);
  command->callback([options, &exit_code] {
    options->run.reader = reader_options(options->file);
    if (options->is_summary) options->run.what = cl::RunOptions::Output::kSummary;
    if (options->is_json) options->run.what = cl::RunOptions::Output::kJson;
    exit_code = cl::run_cl(options->run, std::cout, std::cerr);
  });
}

}  // namespace meridian::cli
