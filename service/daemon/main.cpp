// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "interpolator_version.hpp"
#include "service/daemon/serve.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/manual/manual.hpp"
#include "service/text/line_output.hpp"
#include "service/text/printable.hpp"

namespace meridian::interpolator {
namespace {

enum ExitCode { kFine = 0, kCannotStart = 1, kUsage = 2, kConfigRefused = 3 };

/// On standard error, unless nobody reads it.
void complain(const std::exception& error) {
  text::LineOutput out(STDERR_FILENO);
  const std::string words = text::printable(error.what(), std::string::npos, text::Newlines::kKept);
  (void)out.try_write("meridiand: " + words + "\n");
}

int run(int argc, char** argv) {
  ServeOptions options;
  bool is_manual = false;
  CLI::App app{"The service of Meridian: CL blocks in, joint setpoints out, at a fixed rate."};
  app.set_version_flag("--version", std::string("meridiand ") + kVersion);
  app.add_option("--machine", options.machine, "machine file (TOML)");
  app.add_option("--service", options.service, "service file (TOML)");
  app.add_option("--domain", options.domain, "DDS domain")
      ->envname("MERIDIAN_DOMAIN")
      ->check(CLI::Range(0, 230));
  app.add_option("--record", options.recording, "write the recording of record here (CSV)");
  app.add_option("--state", options.state,
                 "folder of the journal of the last executed block and, unless --faults names one, "
                 "of the flight recorder's files");
  app.add_option("--faults", options.faults,
                 "folder where the flight recorder writes the last seconds before every fault");
  app.add_option("--trace", options.trace, "write traces of slow cycles into this folder");
  app.add_option("--frame", options.frame, "workpiece: x,y,z[,a,b,c] in mm and deg");
  app.add_flag("--best-effort", options.is_best_effort,
               "run without real-time rights where they are missing");
  app.add_flag(
      "--open-network", options.is_open_network,
      "start though CYCLONEDDS_URI leads off this host without an identity (as open_network "
      "= true in the service file); else that is refused");
  app.add_flag("--man-page", is_manual)->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kFine : kUsage;
  }
  if (is_manual) {
    std::fputs(manual::man_page(app, "meridiand", kVersion, "meridian(1)").c_str(), stdout);
    return kFine;
  }
  try {
    serve(options);
    return kFine;
  } catch (const config::ConfigError& error) {
    complain(error);
    return kConfigRefused;
  } catch (const std::exception& error) {
    complain(error);
    return kCannotStart;
  }
}

}  // namespace
}  // namespace meridian::interpolator

int main(int argc, char** argv) {
  const int code = meridian::interpolator::run(argc, argv);
  meridian::interpolator::end_log();
  return code;
}
