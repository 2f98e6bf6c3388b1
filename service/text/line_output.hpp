// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace meridian::text {

/// Lines for a terminal, a pipe, a socket or a file that somebody else may read or not: writing one
/// never waits for the reader. A pipe or terminal is opened anew for that, so that others who have
/// it open keep theirs as it is. One thread. Proof: tests/unit/text/line_output_test.cpp.
class LineOutput {
 public:
  enum class Result : std::uint8_t {
    kWritten,
    kNoRoom,  ///< nobody reads; nothing of the line will be there
    kFailed   ///< it cannot be written at all: the reader is gone, the disk is full
  };

  /// Writes to what `descriptor` is open on; it must stay open meanwhile.
  explicit LineOutput(int descriptor) noexcept;
  ~LineOutput();
  LineOutput(const LineOutput&) = delete;
  LineOutput& operator=(const LineOutput&) = delete;

  /// Writes `line`, which ends with its newline. What was begun of a line is always ended first.
  [[nodiscard]] Result try_write(std::string_view line) noexcept;
  /// Waits until there may be room, no longer than `patience`.
  void wait(std::chrono::milliseconds patience) const noexcept;

 private:
  enum class Kind : std::uint8_t { kFile, kSocket, kPipe };
  [[nodiscard]] long put(std::string_view bytes) const noexcept;

  int file_;
  bool is_own_ = false;  ///< opened anew
  Kind kind_ = Kind::kFile;
  std::string rest_;  ///< of a line that was begun
};

}  // namespace meridian::text
