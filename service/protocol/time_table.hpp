// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meridian::stream {

/// How much of a program's ideal time lies before a block. Bounded memory for programs of any
/// length: entries are thinned out as they come. Unit: s.
/// Proof: tests/unit/protocol/progress_test.cpp.
class TimeTable {
 public:
  /// Appends the next block with its ideal time.
  void append(double time_s) {
    if (blocks_ % stride_ == 0) {
      if (entries_.size() == kEntries) thin_out();
      if (blocks_ % stride_ == 0) entries_.push_back(total_s_);
    }
    ++blocks_;
    total_s_ += time_s;
  }

  [[nodiscard]] std::uint64_t blocks() const noexcept { return blocks_; }
  [[nodiscard]] double total_s() const noexcept { return total_s_; }

  /// Returns the ideal time of all blocks before `block`, interpolated between entries.
  [[nodiscard]] double before(std::uint64_t block) const noexcept {
    if (block >= blocks_) return total_s_;
    const auto at = static_cast<std::size_t>(block / stride_);
    const bool is_last = at + 1 >= entries_.size();
    const double end = is_last ? total_s_ : entries_[at + 1];
    const std::uint64_t begin_block = at * stride_;
    const std::uint64_t end_block = is_last ? blocks_ : begin_block + stride_;
    const double part =
        static_cast<double>(block - begin_block) / static_cast<double>(end_block - begin_block);
    return entries_[at] + part * (end - entries_[at]);
  }

 private:
  void thin_out() {
    for (std::size_t i = 0; 2 * i < entries_.size(); ++i) entries_[i] = entries_[2 * i];
    entries_.resize((entries_.size() + 1) / 2);
    stride_ *= 2;
  }

  static constexpr std::size_t kEntries = 4096;
  std::vector<double> entries_;  ///< time before block i · stride_
  std::uint64_t stride_ = 1, blocks_ = 0;
  double total_s_ = 0;
};

}  // namespace meridian::stream
