// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "meridian/expected.hpp"
#include "service/recording/record/file/record_error.hpp"

namespace meridian::ros {

/// A row of the file of events beside a recording (docs/recordings.md).
struct EventsRow {
  std::uint64_t cycle = 0;
  std::string text;            ///< the verb and what follows it, with spaces between
  bool is_incomplete = false;  ///< says that events are missing, and nothing else
};

/// Reads that file row by row, in constant memory. Proof: tests/unit/ros/event_test.cpp.
class EventsFile {
 public:
  /// A file that is not there is one without rows.
  explicit EventsFile(const std::string& path);
  /// The next row; nothing after the last one.
  [[nodiscard]] Expected<std::optional<EventsRow>, record::RecordError> next();

 private:
  std::string path_;
  std::ifstream file_;
  std::uint64_t line_ = 0;
};

}  // namespace meridian::ros
