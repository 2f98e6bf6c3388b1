// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/manual/manual.hpp"

namespace meridian::cli::manual_command {
namespace {

[[nodiscard]] bool write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (file.flush()) return true;
  std::cerr << "meridian manual: " << path.string() << " cannot be written\n";
  return false;
}

/// One page for the tool and one for each subcommand; the completion beside them.
int write_all(const CLI::App& app, const std::filesystem::path& folder) {
  const std::string name = "meridian";
  std::string pages = "meridiand(1)";
  bool is_written = write(folder / "meridian.bash", manual::bash_completion(app, name));
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (sub->get_group().empty()) continue;
    const std::string page = name + "-" + sub->get_name();
    is_written =
        is_written && write(folder / (page + ".1"),
                            manual::man_page(*sub, name + " " + sub->get_name(), MERIDIAN_VERSION,
                                             name + "(1), meridiand(1)"));
    pages += ", " + page + "(1)";
  }
  is_written = is_written &&
               write(folder / (name + ".1"), manual::man_page(app, name, MERIDIAN_VERSION, pages));
  return is_written ? kFine : kInputRefused;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::string>();
  CLI::App* const command = app.add_subcommand(
      "manual", "Manual pages and bash completion of this tool, written into a folder");
  command->add_option("folder", *folder, "Where to")->required();
  command->callback([folder, &app, &exit_code] { exit_code = write_all(app, *folder); });
}

}  // namespace meridian::cli::manual_command
