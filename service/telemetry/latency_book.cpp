// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/latency_book.hpp"

#include <algorithm>
#include <cmath>

namespace meridian::telemetry {

std::size_t LatencyBook::bucket_of(std::int64_t value_ns) noexcept {
  static const auto kUpper_ns = [] {
    std::array<double, dds::kHistogramBuckets - 1> upper{};
    for (std::size_t i = 0; i < upper.size(); ++i) {
      upper[i] = 256.0 * std::exp2(static_cast<double>(i + 1) / 4);
    }
    return upper;
  }();
  const auto value = static_cast<double>(value_ns);
  const auto place = std::lower_bound(kUpper_ns.begin(), kUpper_ns.end(), value);
  return static_cast<std::size_t>(place - kUpper_ns.begin());
}

dds::HistogramSnapshot LatencyBook::snapshot() const {
  return {.name = name_,
          .count = histogram_.count(),
          .p50_ns = histogram_.percentile_ns(0.5),
          .p99_ns = histogram_.percentile_ns(0.99),
          .p999_ns = histogram_.percentile_ns(0.999),
          .max_ns = histogram_.max_ns(),
          .buckets = buckets_};
}

}  // namespace meridian::telemetry
