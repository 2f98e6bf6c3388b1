// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/rt/histogram.hpp"
#include "service/dds/messages.hpp"

namespace meridian::telemetry {

/// A histogram as the latency topic shows it. One thread.
class LatencyBook {
 public:
  explicit LatencyBook(std::string name) : name_(std::move(name)) {}

  void record(std::int64_t value_ns) noexcept {
    histogram_.record(value_ns);
    ++buckets_[bucket_of(value_ns)];
  }
  [[nodiscard]] dds::HistogramSnapshot snapshot() const;
  [[nodiscard]] const Histogram& histogram() const noexcept { return histogram_; }

  /// Place in HistogramSnapshot::buckets: i holds values up to 256 ns · 2^((i + 1) / 4).
  [[nodiscard]] static std::size_t bucket_of(std::int64_t value_ns) noexcept;

 private:
  std::string name_;
  Histogram histogram_;
  std::array<std::uint64_t, dds::kHistogramBuckets> buckets_{};
};

}  // namespace meridian::telemetry
