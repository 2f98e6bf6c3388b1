// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace meridian::drive {

/// Who sent what the drives dropped: says of each source once that it is to be reported, and never
/// two within a second. Fixed memory: a source that was reported long ago may be reported again.
/// Proof: tests/unit/drive_kit/foreign_sources_test.cpp.
class ForeignSources {
 public:
  /// One that just takes over, or has not heard of the master yet, is not worth a line.
  static constexpr std::int64_t kPatience_ns = 250'000'000;
  static constexpr std::int64_t kBetween_ns = 1'000'000'000;

  /// A sample of `source` was dropped.
  [[nodiscard]] bool is_to_be_reported(std::uint64_t source, std::int64_t now_ns) noexcept {
    const auto known = std::find_if(known_.begin(), known_.end(),
                                    [source](const Known& one) { return one.source == source; });
    Known& one = known != known_.end() ? *known : known_[next_++ % known_.size()];
    if (known == known_.end()) one = {source, now_ns, false};
    if (one.is_reported || now_ns - one.first_ns < kPatience_ns) return false;
    if (reported_ns_ != 0 && now_ns - reported_ns_ < kBetween_ns) return false;
    reported_ns_ = now_ns;
    one.is_reported = true;
    return true;
  }

 private:
  struct Known {
    std::uint64_t source = 0;
    std::int64_t first_ns = 0;  ///< when a sample of it was dropped first
    bool is_reported = false;
  };
  std::array<Known, 64> known_{};  ///< in a ring
  std::size_t next_ = 0;
  std::int64_t reported_ns_ = 0;
};

}  // namespace meridian::drive
