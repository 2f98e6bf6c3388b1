// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "service/machine/file/sections/service_file.hpp"

namespace meridian::probe {

/// The section [realtime] of a service file that says all of `realtime`.
[[nodiscard]] std::string realtime_section(const config::RealtimeConfig& realtime);

/// How the service under measurement is started, and where.
struct ServiceSetup {
  std::uint32_t domain = 0;
  std::filesystem::path folder{};  ///< gets its service file, recording and log
  std::string machine{}, name{};   ///< machine file, and the name in it
  std::int64_t period_ns = 0;      ///< its cycle
  config::RealtimeConfig realtime{};

  /// The command line that serves and records; writes the service file that it names: the real
  /// time of `realtime`, best effort, and nothing else of a service that has its own work to do.
  [[nodiscard]] std::vector<std::string> command(const std::filesystem::path& recording) const;
};

}  // namespace meridian::probe
