// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace meridian {

/// Distribution of durations in nanoseconds in fixed memory: 32 equal buckets per power of two, so
/// that a percentile is at most 1/32 too large, never too small; exact below 32 ns and for the
/// maximum. Values beyond 2^40 ns (18 min) count in the last bucket. Trivially copyable: a snapshot
/// is a copy.
///
/// RT: cycle (record). Proof: tests/unit/rt/histogram_test.cpp.
class Histogram {
 public:
  /// Counts one value; negative ones count as zero.
  void record(std::int64_t value_ns) noexcept {
    const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(value_ns, 0));
    ++buckets_[index_of(value)];
    ++count_;
    max_ = std::max(max_, value);
    sum_ += value;
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::int64_t max_ns() const noexcept { return static_cast<std::int64_t>(max_); }
  [[nodiscard]] double mean_ns() const noexcept {
    return count_ == 0 ? 0 : static_cast<double>(sum_) / static_cast<double>(count_);
  }

  /// Smallest value that at least `share` (0 to 1) of all values do not exceed, rounded up to the
  /// end of its bucket; 0 if nothing was recorded.
  [[nodiscard]] std::int64_t percentile_ns(double share) const noexcept {
    const double wanted = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      seen += buckets_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted) {
        return static_cast<std::int64_t>(std::min(last_of(i), max_));
      }
    }
    return max_ns();
  }

  /// Adds what `other` has counted.
  void merge(const Histogram& other) noexcept {
    for (std::size_t i = 0; i < kBuckets; ++i) buckets_[i] += other.buckets_[i];
    count_ += other.count_;
    sum_ += other.sum_;
    max_ = std::max(max_, other.max_);
  }

  void clear() noexcept { *this = Histogram{}; }

 private:
  static constexpr int kSubBits = 5, kTopBits = 40;
  static constexpr std::size_t kSub = std::size_t{1} << kSubBits;
  static constexpr std::size_t kBuckets = kSub * (kTopBits - kSubBits + 1);

  /// Values below 2·kSub have a bucket each; an octave above is cut into kSub equal parts.
  [[nodiscard]] static constexpr std::size_t index_of(std::uint64_t value) noexcept {
    const int shift = std::max(0, static_cast<int>(std::bit_width(value)) - kSubBits - 1);
    const std::size_t index = kSub * static_cast<std::size_t>(shift) + (value >> shift);
    return std::min(index, kBuckets - 1);
  }
  [[nodiscard]] static constexpr std::uint64_t last_of(std::size_t index) noexcept {
    if (index < 2 * kSub) return index;
    const std::size_t shift = index / kSub - 1;
    return ((kSub + index % kSub + 1) << shift) - 1;
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0, max_ = 0, sum_ = 0;
};
static_assert(std::is_trivially_copyable_v<Histogram>);

}  // namespace meridian
