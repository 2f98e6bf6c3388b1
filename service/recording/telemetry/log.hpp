// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "service/recording/telemetry/words.hpp"

namespace meridian::telemetry {

/// How loud the log says it.
[[nodiscard]] inline spdlog::level::level_enum level_of(Weight weight) noexcept {
  if (weight == Weight::kError) return spdlog::level::err;
  return weight == Weight::kWarning ? spdlog::level::warn : spdlog::level::info;
}

/// The service's log: lines are queued and written by a thread of their own, so that a blocked
/// terminal or a full disk holds nobody up; when the queue is full the oldest lines go. `file`
/// empty: standard error. Lines that were lost are counted, and the next that is written says how
/// many. What DDS says goes into it too (service/transport/cyclone/dds_log.hpp). Throws
/// spdlog::spdlog_ex where the file cannot be opened. Call once. Proof:
/// tests/integration/blocked_log_test.cpp.
[[nodiscard]] std::shared_ptr<spdlog::logger> make_log(const std::filesystem::path& file);

/// Writes what is queued and ends the log's thread; where nobody reads for as long as `patience`,
/// the rest is lost.
void end_log(std::chrono::milliseconds patience = std::chrono::milliseconds(500));

}  // namespace meridian::telemetry
