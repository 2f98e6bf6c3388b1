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
/// RT: cycle (record). Proof: tests/unit/cycle/histogram_test.cpp.
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

  /// Counts a value that was measured once every `interval_ns`, and with it the measurements that
  /// it kept from being made: value, value - interval, value - 2 interval, ... down to above 0 (at
  /// most kMaxOmitted). Without them a thread that was held up for ten periods would count one bad
  /// one instead of ten. Source: Tene, "How NOT to measure latency" (coordinated omission).
  void record_every(std::int64_t value_ns, std::int64_t interval_ns) noexcept {
    record(value_ns);
    if (interval_ns <= 0) return;
    std::int64_t omitted_ns = value_ns - interval_ns;
    for (int i = 0; i < kMaxOmitted && omitted_ns > 0; ++i, omitted_ns -= interval_ns) {
      record(omitted_ns);
    }
  }
  static constexpr int kMaxOmitted = 1 << 16;

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

  /// What was counted since `earlier`, a copy of this histogram at an earlier time. Its maximum is
  /// the whole one's where that is new, else the end of the last bucket that grew.
  [[nodiscard]] Histogram since(const Histogram& earlier) const noexcept {
    Histogram grown;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      grown.buckets_[i] = buckets_[i] - std::min(buckets_[i], earlier.buckets_[i]);
      grown.count_ += grown.buckets_[i];
      if (grown.buckets_[i] > 0) grown.max_ = std::min(last_of(i), max_);
    }
    if (max_ > earlier.max_) grown.max_ = max_;
    grown.sum_ = sum_ - std::min(sum_, earlier.sum_);
    return grown;
  }

  void clear() noexcept { *this = Histogram{}; }

  static constexpr int kSubBits = 5, kTopBits = 40;
  static constexpr std::size_t kSub = std::size_t{1} << kSubBits;
  static constexpr std::size_t kBuckets = kSub * (kTopBits - kSubBits + 1);

  /// How many values bucket `index` below kBuckets holds, and the largest value that belongs there.
  [[nodiscard]] std::uint64_t bucket(std::size_t index) const noexcept { return buckets_[index]; }
  [[nodiscard]] static constexpr std::int64_t bucket_end_ns(std::size_t index) noexcept {
    return static_cast<std::int64_t>(last_of(index));
  }
  [[nodiscard]] std::uint64_t sum_ns() const noexcept { return sum_; }

  /// Restores a histogram from what it reported: buckets one by one, then sum and maximum.
  void restore_bucket(std::size_t index, std::uint64_t values) noexcept {
    if (index >= kBuckets) return;
    count_ += values - buckets_[index];
    buckets_[index] = values;
  }
  void restore_sum_and_max(std::uint64_t sum_ns, std::int64_t max_ns) noexcept {
    sum_ = sum_ns;
    max_ = static_cast<std::uint64_t>(std::max<std::int64_t>(max_ns, 0));
  }

 private:
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
