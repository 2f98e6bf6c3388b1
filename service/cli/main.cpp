// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <string>

#include "service/cli/commands.hpp"
#include "service/text/printable.hpp"
#include "service/transport/cyclone/dds_log.hpp"

namespace {

constexpr const char* kFooter =
    "Exit codes: 0 fine, 1 the verdict is no, 2 usage, 3 input refused, 4 the machine refused,\n"
    "5 no peer. `meridian SUBCOMMAND --help` says what a subcommand takes, `--help-all` "
    "everything.";

}  // namespace

int main(int argc, char** argv) {
  using namespace meridian::cli;
  int exit_code = kFine;
  meridian::dds::log_to_stderr();
  try {
    CLI::App app(
        "meridian: CAM station, operator's panel, simulated drives, simulator and checker");
    app.set_help_all_flag("--help-all", "Print the help of every subcommand and exit");
    app.set_version_flag("--version", "meridian " MERIDIAN_VERSION);
    app.require_subcommand(1);
    app.footer(kFooter);
    add_commands(app, exit_code);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? kFine : kUsage;
    }
  } catch (const std::exception& error) {
    const std::string words =
        meridian::text::printable(error.what(), std::string::npos, meridian::text::Newlines::kKept);
    std::fprintf(stderr, "meridian: %s\n", words.c_str());
    return kInputRefused;
  }
  return exit_code;
}
