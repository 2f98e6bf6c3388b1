// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace meridian::interpolator {

/// What the command line of meridiand says; an empty text is an option that was not given.
struct ServeOptions {
  std::string machine, service, recording, state, faults, frame, trace;
  int domain = -1;  ///< below 0: as the service file says
  bool is_best_effort = false, is_open_network = false;
};

/// Reads the machine, service and tool files, starts the service and returns after SIGINT or
/// SIGTERM, when the machine is Off. Throws config::ConfigError where a file is refused, StartError
/// and others where the service cannot start.
void serve(const ServeOptions& options);

/// Writes what the log still holds. The last call of the program.
void end_log();

}  // namespace meridian::interpolator
