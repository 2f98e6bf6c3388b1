// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace meridian::stream {

/// Which blocks of a session are the last of their source line: an arc is many blocks of one line.
/// Lines of one block take no room. Proof: tests/unit/protocol/line_ends_test.cpp.
class LineEnds {
 public:
  /// A session begins.
  void clear() noexcept { *this = LineEnds(); }
  /// The next block; `sequence` counts from 0.
  void add(std::uint64_t sequence, std::uint32_t line) {
    const bool is_same = sequence > 0 && line == line_;
    if (is_same && !lines_.empty() && lines_.back().last + 1 == sequence) {
      lines_.back().last = sequence;
    } else if (is_same) {
      lines_.push_back({sequence - 1, sequence});
    }
    line_ = line;
    next_ = sequence + 1;
    if (lines_.size() > kMaxLines) lines_.pop_front();
  }
  /// No block follows.
  void end() noexcept { is_ended_ = true; }

  /// Whether `block` is the last of its line; false also where that is not known. Blocks in front
  /// of one for which it was known are not asked for any more.
  [[nodiscard]] bool is_line_end(std::uint64_t block) {
    const bool is_known = block + 1 < next_ || (is_ended_ && block + 1 == next_);
    if (!is_known) return false;
    while (!lines_.empty() && lines_.front().last < block) lines_.pop_front();
    return lines_.empty() || lines_.front().first > block || lines_.front().last == block;
  }

 private:
  static constexpr std::size_t kMaxLines = 65'536;
  struct Blocks {
    std::uint64_t first = 0, last = 0;
  };
  std::deque<Blocks> lines_;  ///< lines of several blocks
  std::uint64_t next_ = 0;
  std::uint32_t line_ = 0;
  bool is_ended_ = false;
};

}  // namespace meridian::stream
