// SPDX-License-Identifier: Apache-2.0

/// The percentile table against order statistics: every line is computed once more from the sorted
/// samples, no histogram between.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "service/text/percentiles.hpp"

namespace meridian::text {
namespace {

Histogram histogram_of(const std::vector<std::int64_t>& samples_ns) {
  Histogram histogram;
  for (const std::int64_t sample : samples_ns) histogram.record(sample);
  return histogram;
}

/// Below 64 ns each value has a bucket of its own, so HdrHistogram's table of these samples is
/// known to the last letter (worked out by PercentileIterator's rules from the sorted samples).
TEST(PercentileTable, IsThatOfHdrHistogramToTheLetter) {
  const std::string table = percentile_table(histogram_of({21, 1, 8, 55, 1, 2, 34, 3, 5, 13}));
  const std::string wanted =
      "       Value     Percentile TotalCount 1/(1-Percentile)\n\n"
      "       0.001 0.000000000000          2           1.00\n"
      "       0.001 0.100000000000          2           1.11\n"
      "       0.001 0.200000000000          2           1.25\n"
      "       0.002 0.300000000000          3           1.43\n"
      "       0.003 0.400000000000          4           1.67\n"
      "       0.005 0.500000000000          5           2.00\n"
      "       0.008 0.550000000000          6           2.22\n"
      "       0.008 0.600000000000          6           2.50\n"
      "       0.013 0.650000000000          7           2.86\n"
      "       0.013 0.700000000000          7           3.33\n"
      "       0.021 0.750000000000          8           4.00\n"
      "       0.021 0.775000000000          8           4.44\n"
      "       0.021 0.800000000000          8           5.00\n"
      "       0.034 0.825000000000          9           5.71\n"
      "       0.034 0.850000000000          9           6.67\n"
      "       0.034 0.875000000000          9           8.00\n"
      "       0.034 0.887500000000          9           8.89\n"
      "       0.034 0.900000000000          9          10.00\n"
      "       0.055 0.912500000000         10          11.43\n"
      "       0.055 1.000000000000         10\n"
      "#[Mean    =        0.014, StdDeviation   =        0.017]\n"
      "#[Max     =        0.055, Total count    =           10]\n";
  EXPECT_EQ(table.substr(0, wanted.size()), wanted);
}

struct Line {
  double value_us = 0, share = 0;
  std::uint64_t count = 0;
};

std::vector<Line> lines_of(const std::string& table) {
  std::vector<Line> lines;
  std::istringstream text(table);
  for (std::string row; std::getline(text, row) && !row.starts_with('#');) {
    Line line;
    std::istringstream cells(row);
    if (cells >> line.value_us >> line.share >> line.count) lines.push_back(line);
  }
  return lines;
}

TEST(PercentileTable, HoldsTheOrderStatisticsOfAnyLatencies) {
  constexpr double kPrinted_us = 0.0005, kPrinted_share = 1e-12;
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 engine(seed);
    std::lognormal_distribution<double> latency(10 + seed,
                                                0.5 * seed);  // 60 us and more, long tail
    std::vector<std::int64_t> samples(20'000);
    for (std::int64_t& sample : samples) sample = std::llround(latency(engine));
    const std::vector<Line> lines = lines_of(percentile_table(histogram_of(samples)));
    std::sort(samples.begin(), samples.end());
    ASSERT_GT(lines.size(), 50U);
    double level = 0, left = 1;  // five steps, then half is left of what was
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      const Line& line = lines[i];
      EXPECT_NEAR(line.share, level, kPrinted_share);
      const auto rank = static_cast<std::size_t>(std::ceil(level * 20'000 - 1e-6));
      const double exact_us =
          1e-3 * static_cast<double>(samples[std::max<std::size_t>(rank, 1) - 1]);
      EXPECT_GE(line.value_us, exact_us - kPrinted_us) << level;
      EXPECT_LE(line.value_us, exact_us * (1 + 1.0 / 32) + kPrinted_us) << level;
      const double max_ns = 1e3 * (line.value_us + kPrinted_us);
      const auto above = std::upper_bound(samples.begin(), samples.end(), max_ns);
      EXPECT_EQ(line.count, static_cast<std::uint64_t>(above - samples.begin()))
          << level << ": samples that the printed value does not exceed";
      level += left / 10;
      if ((i + 1) % 5 == 0) left /= 2;
    }
    EXPECT_EQ(lines.back().share, 1);
    EXPECT_EQ(lines.back().count, samples.size());
    EXPECT_NEAR(lines.back().value_us, 1e-3 * static_cast<double>(samples.back()), kPrinted_us);
  }
}

TEST(PercentileTable, OfNothingHasNoNumberThatIsNone) {
  EXPECT_EQ(percentile_table(Histogram{}).find("nan"), std::string::npos);
  EXPECT_EQ(lines_of(percentile_table(histogram_of({7}))).size(), 2U);  // 0 and 100 %
}

TEST(PercentileTable, HasAFileNameForEveryLatency) {
  EXPECT_EQ(percentile_file_name("publisher's wake"), "publishers-wake.hgrm");
}

}  // namespace
}  // namespace meridian::text
