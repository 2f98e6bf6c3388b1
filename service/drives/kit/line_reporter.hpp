// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

#include "meridian/cycle/spsc_ring.hpp"

namespace meridian::drive {

/// Prints lines for a thread that may not wait: a terminal that is held, a pipe that nobody reads
/// or a busy disk stops a thread of its own instead. Lines that find no room are lost, and another
/// one says how many. Proof: tests/unit/drive_kit/line_reporter_test.cpp.
class LineReporter {
 public:
  using Print = std::function<void(const std::string&)>;
  /// `print` is called on a thread that begins here, with the scheduling of who calls.
  explicit LineReporter(Print print);
  /// Prints what is left.
  ~LineReporter();
  LineReporter(const LineReporter&) = delete;
  LineReporter& operator=(const LineReporter&) = delete;

  /// One thread. What is behind kMaxBytes of a line is left out.
  void write_line(std::string_view line) noexcept;

  static constexpr std::size_t kMaxLines = 256, kMaxBytes = 252;

 private:
  struct Line {
    std::uint32_t length = 0;
    std::array<char, kMaxBytes> text;
  };
  void print_waiting();

  SpscRing<Line, kMaxLines> lines_;
  std::atomic<std::uint64_t> lost_{0};
  std::uint64_t lost_reported_ = 0;
  Print print_;
  std::jthread thread_;
};

}  // namespace meridian::drive
