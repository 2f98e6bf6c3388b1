// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "service/telemetry/words.hpp"

namespace meridian::telemetry {

/// How loud the log says it.
[[nodiscard]] inline spdlog::level::level_enum level_of(Weight weight) noexcept {
  if (weight == Weight::kError) return spdlog::level::err;
  return weight == Weight::kWarning ? spdlog::level::warn : spdlog::level::info;
}

/// The service's log: lines are queued and written by a thread of their own, so that a blocked
/// terminal or a full disk holds nobody up; when the queue is full the oldest lines go. `file`
/// empty: standard error. Throws spdlog::spdlog_ex where the file cannot be opened. Call once.
[[nodiscard]] std::shared_ptr<spdlog::logger> make_log(const std::filesystem::path& file);

}  // namespace meridian::telemetry
