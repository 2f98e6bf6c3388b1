// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/latency_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] json stage_of(const char* name, std::int64_t value_ns) {
  dds::Latency latency;
  latency.histograms.push_back({name, {}});
  for (int i = 0; i < 1000; ++i) latency.histograms[0].histogram.record(value_ns);
  return json::parse(latency_text(latency, 1'000'000, known_budgets()))["stages"][0];
}

TEST(LatencyText, EveryValueIsInTheBinOfItsTime) {
  const json stage = stage_of("DDS write", 10'000);
  const auto bins = stage["bins"].get<std::vector<std::uint64_t>>();
  EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), std::uint64_t{0}), 1000U);
  // 10 µs is 5.29 octaves above 0.256 µs.
  EXPECT_EQ(bins[21], 1000U);
  EXPECT_NEAR(stage["p99"].get<double>(), 10, 0.4);
}

TEST(LatencyText, AStageStandsBesideItsBudgets) {
  const json stage = stage_of("cycle computation", 4'000);
  ASSERT_EQ(stage["budgets"].size(), 3U);
  bool has_missed = false;
  for (const json& budget : stage["budgets"]) {
    ASSERT_TRUE(budget.contains("limit")) << budget;
    const bool is_median = budget["statistic"] == "p50";
    EXPECT_EQ(budget["figure"].get<double>() <= budget["limit"].get<double>(), !is_median);
    has_missed = has_missed || is_median;
  }
  EXPECT_TRUE(has_missed);
}

TEST(LatencyText, ABudgetByComparisonHasWordsAlone) {
  const json stage = stage_of("wake-up lateness", 40'000);
  ASSERT_EQ(stage["budgets"].size(), 1U);
  EXPECT_FALSE(stage["budgets"][0].contains("limit"));
  EXPECT_NE(stage["budgets"][0]["text"].get<std::string>().find("bare thread"), std::string::npos);
}

}  // namespace
}  // namespace meridian::panel
