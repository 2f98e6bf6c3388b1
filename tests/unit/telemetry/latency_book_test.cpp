// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/latency_book.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace meridian::telemetry {
namespace {

TEST(LatencyBook, PutsEveryValueUnderTheUpperEdgeOfItsBucket) {
  for (std::int64_t value = -5; value < 40'000'000;
       value = value < 300 ? value + 1 : value * 21 / 20) {
    const std::size_t bucket = LatencyBook::bucket_of(value);
    ASSERT_LT(bucket, dds::kHistogramBuckets);
    const auto edge = [](std::size_t i) {
      return 256.0 * std::exp2((static_cast<double>(i) + 1) / 4);
    };
    if (bucket + 1 < dds::kHistogramBuckets) {
      EXPECT_LE(static_cast<double>(value), edge(bucket));
    }
    if (bucket > 0) {
      EXPECT_GT(static_cast<double>(value), edge(bucket - 1));
    }
  }
}

TEST(LatencyBook, ShowsWhatItCounted) {
  LatencyBook book("wake-up lateness");
  for (int i = 1; i <= 1000; ++i) book.record(i * 1000);
  const dds::HistogramSnapshot shown = book.snapshot();
  EXPECT_EQ(shown.name, "wake-up lateness");
  EXPECT_EQ(shown.count, 1000U);
  EXPECT_EQ(std::accumulate(shown.buckets.begin(), shown.buckets.end(), std::uint64_t{0}), 1000U);
  EXPECT_NEAR(static_cast<double>(shown.p50_ns), 500'000, 500'000.0 / 30);
  EXPECT_NEAR(static_cast<double>(shown.p99_ns), 990'000, 990'000.0 / 30);
  EXPECT_EQ(shown.max_ns, 1'000'000);
}

}  // namespace
}  // namespace meridian::telemetry
