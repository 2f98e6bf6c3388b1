// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/figures.hpp"

#include <gtest/gtest.h>

namespace meridian::probe {
namespace {

TEST(Figures, PercentilesAreByNearestRank) {
  std::vector<std::int64_t> samples;
  for (std::int64_t i = 1000; i >= 1; --i) {
    samples.push_back(i * 1000);
  }
  const Figures figures = figures_of(samples);
  EXPECT_EQ(figures.p50_us, 500);
  EXPECT_EQ(figures.p99_us, 990);
  EXPECT_EQ(figures.p999_us, 999);
  EXPECT_EQ(figures.max_us, 1000);
  EXPECT_EQ(figures.samples, 1000U);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(Figures, StallsAreCountedApart) {
  Turns turns("lateness");
  turns.add({10'000, 999'999, 1'000'000});
  turns.add({25'000'000, 5});
  EXPECT_EQ(turns.stalls(), 2U);
  EXPECT_EQ(turns.histogram().count(), 5U);
  EXPECT_EQ(turns.histogram().max_ns(), 25'000'000);
}

TEST(Figures, AWakeUpThatSleptThroughPeriodsStandsForAllOfThem) {
  EXPECT_EQ(with_omitted({50, 2050, 1000, 999}, 1000),
            (std::vector<std::int64_t>{50, 2050, 1050, 50, 1000, 999}));
  EXPECT_EQ(with_omitted({5000}, 0), std::vector<std::int64_t>{5000});
  Histogram corrected, expected;
  for (const std::int64_t late : with_omitted({10'500'000}, 1'000'000)) corrected.record(late);
  expected.record_every(10'500'000, 1'000'000);
  EXPECT_EQ(corrected.count(), 11U);
  EXPECT_EQ(corrected.sum_ns(), expected.sum_ns());
}

TEST(Figures, TheHistogramOfLatenessesHasWhatWasSleptThroughAndEachStallOnce) {
  Turns turns("lateness");
  turns.add({50'000, 10'500'000, 60'000}, 1'000'000);
  EXPECT_EQ(turns.histogram().count(), 13U);
  EXPECT_EQ(turns.samples(), 13U);
  EXPECT_EQ(turns.stalls(), 1U);
  EXPECT_GT(turns.median_p50_us(), 1000) << "10 of 13 wake-ups were a period late";
}

TEST(Figures, ATurnWithoutSamplesIsNotAFastOne) {
  Turns turns("lateness");
  turns.add({});
  turns.add({30'000});
  turns.add({});
  EXPECT_EQ(turns.median_p50_us(), 30);
  EXPECT_EQ(turns.median_p99_us(), 30);
  EXPECT_EQ(turns.count(), 3U);
  EXPECT_EQ(turns.samples(), 1U);
}

}  // namespace
}  // namespace meridian::probe
