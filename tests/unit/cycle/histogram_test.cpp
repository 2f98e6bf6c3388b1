// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

namespace meridian {
namespace {

TEST(Histogram, GivesPercentilesThatAreAtMostAThirtySecondTooLargeAndNeverTooSmall) {
  constexpr unsigned kSeed = 7;
  std::cout << "seed " << kSeed << "\n";
  std::mt19937_64 draw(kSeed);
  std::uniform_real_distribution<double> exponent(0, 30);
  std::vector<std::int64_t> values;
  Histogram histogram;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(static_cast<std::int64_t>(std::exp2(exponent(draw))));
    histogram.record(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    const auto exact = static_cast<double>(values[static_cast<std::size_t>(rank) - 1]);
    const auto reported = static_cast<double>(histogram.percentile_ns(share));
    EXPECT_GE(reported, exact) << share;
    EXPECT_LE(reported, exact * (1 + 1.0 / 32)) << share;
  }
  EXPECT_EQ(histogram.max_ns(), values.back());
}

TEST(Histogram, EndsABucketWhereTheNextBegins) {
  for (std::int64_t value = 1; value < 5000; ++value) {
    Histogram histogram;
    histogram.record(value);
    histogram.record(1 << 20);
    std::size_t index = 0;
    while (histogram.bucket(index) == 0) ++index;
    EXPECT_LE(value, Histogram::bucket_end_ns(index));
    EXPECT_GT(value, index == 0 ? -1 : Histogram::bucket_end_ns(index - 1));
  }
  EXPECT_EQ(Histogram::bucket_end_ns(63), 63);
  EXPECT_EQ(Histogram::bucket_end_ns(64), 65);
  EXPECT_EQ(Histogram::bucket_end_ns(96), 131);
}

TEST(Histogram, AShareBeyondAllIsTheLargestAndOneBelowNoneTheSmallest) {
  Histogram histogram;
  for (int i = 1; i <= 10; ++i) histogram.record(i);
  EXPECT_EQ(histogram.percentile_ns(3), 10);
  EXPECT_EQ(histogram.percentile_ns(-1), 1);
}

TEST(Histogram, IsExactForSmallValues) {
  Histogram histogram;
  for (int i = 1; i <= 10; ++i) histogram.record(i);
  EXPECT_EQ(histogram.percentile_ns(0.5), 5);
  EXPECT_EQ(histogram.count(), 10u);
  EXPECT_DOUBLE_EQ(histogram.mean_ns(), 5.5);
}

TEST(Histogram, CountsNegativeValuesAsZeroAndHugeOnesInTheLastBucket) {
  Histogram histogram;
  histogram.record(-5);
  histogram.record(std::int64_t{1} << 60);
  EXPECT_EQ(histogram.percentile_ns(0.5), 0);
  EXPECT_EQ(histogram.max_ns(), std::int64_t{1} << 60);
}

TEST(Histogram, IsEmptyAtFirstAndAfterClear) {
  Histogram histogram;
  EXPECT_EQ(histogram.percentile_ns(0.99), 0);
  histogram.record(3);
  histogram.clear();
  EXPECT_EQ(histogram.count(), 0u);
}

TEST(Histogram, MergesAsIfOneHadRecordedAll) {
  Histogram one, two, both;
  for (int i = 0; i < 100; ++i) {
    (i % 3 == 0 ? one : two).record(i * i);
    both.record(i * i);
  }
  one.merge(two);
  EXPECT_EQ(one.count(), both.count());
  EXPECT_EQ(one.percentile_ns(0.9), both.percentile_ns(0.9));
  EXPECT_EQ(one.max_ns(), both.max_ns());
}

TEST(Histogram, CountsWhatALateOneKeptFromBeingMeasured) {
  Histogram plain, corrected;
  for (int i = 0; i < 990; ++i) {
    plain.record(10'000);
    corrected.record_every(10'000, 1'000'000);
  }
  plain.record(9'500'000);  // nine periods of 1 ms were slept through
  corrected.record_every(9'500'000, 1'000'000);
  EXPECT_EQ(corrected.count(), 1000U);
  EXPECT_LT(plain.percentile_ns(0.995), 11'000);
  EXPECT_GT(corrected.percentile_ns(0.995), 4'500'000);
  EXPECT_EQ(corrected.max_ns(), 9'500'000);
  Histogram endless;
  endless.record_every(INT64_MAX, 1);
  EXPECT_EQ(endless.count(), 1U + Histogram::kMaxOmitted);
}

TEST(Histogram, HoldsWhatWasCountedSinceACopy) {
  Histogram whole;
  for (int i = 1; i <= 100; ++i) whole.record(i * 1000);
  const Histogram before = whole;
  Histogram later;
  for (const int value : {7, 800, 90'000}) {
    whole.record(value);
    later.record(value);
  }
  const Histogram grown = whole.since(before);
  EXPECT_EQ(grown.count(), 3U);
  EXPECT_EQ(grown.sum_ns(), later.sum_ns());
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) EXPECT_EQ(grown.bucket(i), later.bucket(i));
  EXPECT_GE(grown.max_ns(), 90'000);
  EXPECT_LE(grown.max_ns(), 100'000);
  whole.record(5'000'000);
  EXPECT_EQ(whole.since(before).max_ns(), 5'000'000);
}

}  // namespace
}  // namespace meridian
