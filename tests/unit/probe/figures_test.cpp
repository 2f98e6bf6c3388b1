// SPDX-License-Identifier: Apache-2.0
#include "service/probe/figures.hpp"

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

}  // namespace
}  // namespace meridian::probe
