// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/panel/serve/news.hpp"

namespace meridian::panel {

/// What a line of the service's audit log says (docs/security.md): who asked for what and what came
/// of it, sessions, faults, begin and end of the service. Nothing for a line that says none of
/// these.
[[nodiscard]] std::optional<NewsItem> parse_history_line(std::string_view line);

/// The audit log of a service on the same host, as it grows: what happened before the panel began,
/// and who does what while it runs. A log that is put aside goes on in its new file. One thread.
/// Proof: tests/panel/history_test.cpp.
class History {
 public:
  /// At most so much of the end of a file is read, bytes.
  static constexpr std::uint64_t kMaxRead = 256 << 10;

  explicit History(std::filesystem::path file) : file_(std::move(file)) {}

  /// What was written since the last call; the first call: the end of what is there. A file that
  /// cannot be read has nothing to say.
  [[nodiscard]] std::vector<NewsItem> take();

 private:
  std::filesystem::path file_;
  std::uint64_t read_to_ = 0, inode_ = 0;
  std::string torn_;  ///< the begin of a line whose end is not written yet
};

}  // namespace meridian::panel
