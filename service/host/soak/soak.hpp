// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "service/host/soak/report/soak_report.hpp"

namespace meridian::soak {

struct SoakOptions {
  std::string machine, tools;         ///< files; tools empty: none
  std::vector<std::string> programs;  ///< CL files, one after the other; none: drawn ones
  double for_s = 60;
  std::uint64_t seed = 1;
  double chaos_every_s = 0;  ///< mean distance of mishaps; 0: none
  std::uint32_t domain = 0;
  std::string service;          ///< service file whose real time is run; empty: best effort
  std::filesystem::path trace;  ///< folder of traces of slow cycles; empty: none
  /// JSON; text and recordings lie beside it (report_files.hpp). Empty: none on the way.
  std::filesystem::path report;
};

/// Runs service, simulated drives and station as processes, one program after the other, and is
/// their operator, until the time is over or `is_stopping`. Everything the service sends is checked
/// while it runs; the report is written every few seconds. Programs lie beside the running one.
/// Throws config::ConfigError, std::runtime_error or dds::DdsError where it cannot begin.
[[nodiscard]] SoakReport run_soak(const SoakOptions& options, const std::atomic<bool>& is_stopping,
                                  const std::function<void(const std::string&)>& say);

}  // namespace meridian::soak
