// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/surface/sample_part.hpp"

namespace meridian::cli {

void add_surface_command(CLI::App& app, int& exit_code) {
  struct Options {
    std::string sample;
    std::string output;
  };
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("surface", "Make a CL file of a surface");
  command->add_option("--sample", options->sample, "A sample part by its name")
      ->required()
      ->check(CLI::IsMember(surface::sample_names()));
  command->add_option("-o,--output", options->output, "Write to this file; else standard output");
  command->callback([options, &exit_code] {
    if (options->output.empty()) {
      surface::write_sample(options->sample, std::cout);
      return;
    }
    std::ofstream out(options->output, std::ios::binary);
    surface::write_sample(options->sample, out);
    out.flush();
    if (!out) {
      std::cerr << "meridian surface: " << options->output << " cannot be written\n";
      exit_code = kInputRefused;
    }
  });
}

}  // namespace meridian::cli
