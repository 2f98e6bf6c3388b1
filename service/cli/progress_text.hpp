// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "service/protocol/station/progress.hpp"

namespace meridian::cli {

/// Returns "1:05:09" or "5:09".
[[nodiscard]] std::string time_text(double seconds);
/// Returns "block 12 of 340, line 15, feed 1500 of 2000 mm/min, to go 0:42".
[[nodiscard]] std::string progress_text(const stream::ProgressView& view);

/// Prints messages and progress on standard output: a bar that stays on its line on a terminal,
/// plain lines every two seconds in a pipe.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(bool is_terminal) : is_terminal_(is_terminal) {}

  void say(const std::string& text);
  void show(const stream::ProgressView& view);
  void end();

 private:
  void wipe();

  bool is_terminal_;
  bool has_bar_ = false;
  std::string shown_;
  std::chrono::steady_clock::time_point printed_{};
};

}  // namespace meridian::cli
