// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/peer_options.hpp"

namespace meridian::cli {

/// The options of `meridian record` where it listens to a service.
struct LiveOptions {
  std::string output, mcap;  ///< CSV and MCAP file; "": not that one
  MachineOptions machine;    ///< of the MCAP file; none: what the service publishes
  double duration_s = 0;     ///< 0: until it is stopped
  bool until_end = false;
  std::int64_t max_missing = -1;  ///< -1: any
  PeerOptions peer;
};

/// Listens and writes until the time, the program or the operator ends it. Returns the exit code.
/// Throws config::ConfigError.
[[nodiscard]] int record_live(LiveOptions& options);

}  // namespace meridian::cli
