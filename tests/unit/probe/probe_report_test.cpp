// SPDX-License-Identifier: Apache-2.0
#include "service/probe/probe_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "service/probe/cyclictest.hpp"
#include "service/text/percentiles.hpp"

namespace meridian::probe {
namespace {

/// A host where everything takes as long as it may, and `late_us` is the service's p99.
RateMeasurement measured(double late_us) {
  RateMeasurement m;
  m.rate_hz = 1000;
  const auto ns = [](double us) { return static_cast<std::int64_t>(us * 1000); };
  for (int turn = 0; turn < 3; ++turn) {
    m.lateness.add(std::vector<std::int64_t>(100, ns(late_us)));
    m.bare_wake.add(std::vector<std::int64_t>(100, ns(20)));
    m.one_way.add(std::vector<std::int64_t>(100, ns(60)));
    m.bare_one_way.add(std::vector<std::int64_t>(100, ns(30)));
    m.bare_round_trip.add(std::vector<std::int64_t>(100, ns(70)));
  }
  m.computation.add(std::vector<std::int64_t>(1000, 1500));
  for (int i = 0; i < 100; ++i) m.round_trip.record(ns(90));
  m.sent = 300;
  return m;
}

ProbeReport report_of(const RateMeasurement& m, bool is_target) {
  return {"host", is_target, {m}, judge(m)};
}

TEST(Probe, IsFitWhereEveryBudgetIsKept) {
  const ProbeReport report = report_of(measured(25), true);
  EXPECT_TRUE(report.is_fit()) << to_text(report);
  EXPECT_NE(to_text(report).find("\nFIT"), std::string::npos);
  EXPECT_NE(to_json(report).find("\"fit\": true"), std::string::npos);
}

TEST(Probe, IsRefusedWhereItsSamplesWouldFillTheMemory) {
  MeasureOptions options;
  EXPECT_EQ(too_large(options, 2000), "");
  options.turns = 3600;
  options.rates_hz = {8000};
  EXPECT_NE(too_large(options, 2000).find("341 s are what this host has room for"),
            std::string::npos)
      << too_large(options, 2000);
  EXPECT_EQ(too_large(options, 40'000), "");
  options.has_load = true;
  options.rates_hz = {1000, 2000, 4000, 8000};
  EXPECT_NE(too_large(options, 20'000), "");
  EXPECT_GT(available_mib(), 1);
}

TEST(Probe, TargetBudgetsDecideOnlyWhereTheyAreAskedFor) {
  const RateMeasurement m = measured(40);  // 1.5 * 20 + 20 allows it, 1.1 * 20 + 5 does not
  EXPECT_TRUE(report_of(m, false).is_fit());
  EXPECT_FALSE(report_of(m, true).is_fit());
  EXPECT_NE(to_text(report_of(m, true)).find("outside cycle_lateness_target"), std::string::npos);
}

TEST(Probe, IsNotFitWhereTheMachineStopsByItself) {
  RateMeasurement m = measured(25);
  m.computation = Turns("service, cycle computation");
  m.broken_off = "cycle 812: no feedback for 0.1 s";
  const ProbeReport report = report_of(m, false);
  EXPECT_FALSE(report.is_fit());
  EXPECT_NE(to_text(report).find("NO PROGRAM CAN BE CUT HERE: cycle 812: no feedback"),
            std::string::npos);
  EXPECT_EQ(to_text(report).find("cycle_computation_p50"), std::string::npos)
      << "nothing was computed";
  EXPECT_NE(to_json(report).find("\"broken_off\": \"cycle 812"), std::string::npos);
}

TEST(Probe, IsNotFitWhereAJudgedBudgetIsMissed) {
  EXPECT_FALSE(report_of(measured(60), false).is_fit());
  RateMeasurement losing = measured(25);
  losing.lost_periods = 2;  // of 300
  EXPECT_FALSE(report_of(losing, false).is_fit());
  losing.bare_lost_periods = 2;  // the host's doing, then
  EXPECT_TRUE(report_of(losing, false).is_fit());
  RateMeasurement slow = measured(25);
  slow.computation.add(std::vector<std::int64_t>(1000, 600'000));
  EXPECT_FALSE(report_of(slow, false).is_fit());
}

TEST(Probe, ReportedBudgetsNeverDecide) {
  RateMeasurement m = measured(25);
  for (int i = 0; i < 1000; ++i) m.round_trip.record(10'000'000);
  const auto verdicts = judge(m);
  EXPECT_FALSE(std::all_of(verdicts.begin(), verdicts.end(),
                           [](const Verdict& verdict) { return verdict.is_inside(); }));
  EXPECT_TRUE(report_of(m, true).is_fit());
}

TEST(Probe, ReadsTheHistogramOfCyclictest) {
  const auto histogram = parse_cyclictest(
      "# Histogram\n000000 000000\n000007 000003\n000012 000001\n# Total: 000000004\n"
      "# Histogram Overflows: 00002\n# Min Latencies: 00007\n");
  ASSERT_TRUE(histogram);
  EXPECT_EQ(histogram->count(), 6U);
  EXPECT_NEAR(static_cast<double>(histogram->percentile_ns(0.5)), 7000, 7000.0 / 32);
  EXPECT_GE(histogram->max_ns(), 20'000'000);
  EXPECT_FALSE(parse_cyclictest("Unable to change scheduling policy!\n"));
}

TEST(Probe, ChangesTheCycleOfAMachineFileAndNothingElse) {
  EXPECT_EQ(with_cycle_us("[machine]\ncycle_us = 1000   # 125 to 4000\nbridge_cycles = 3\n", 125),
            "[machine]\ncycle_us = 125   # 125 to 4000\nbridge_cycles = 3\n");
  EXPECT_THROW((void)with_cycle_us("[machine]\nname = \"x\"\n", 125), std::runtime_error);
}

TEST(PercentileTable, IsThatOfHdrHistogram) {
  Histogram histogram;
  for (int i = 1; i <= 10; ++i) histogram.record(i * 1000);
  const std::string table = text::percentile_table(histogram);
  EXPECT_EQ(table.rfind("       Value     Percentile TotalCount 1/(1-Percentile)\n\n", 0), 0U);
  EXPECT_NE(table.find("\n       1.007 0.000000000000          1           1.00\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find(" 0.500000000000          5           2.00\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\n      10.000 1.000000000000         10\n#[Mean    ="), std::string::npos)
      << table;
  EXPECT_NE(table.find("#[Max     =       10.000, Total count    =           10]\n"),
            std::string::npos)
      << table;
  EXPECT_EQ(text::percentile_file_name("publisher's wake"), "publishers-wake.hgrm");
  EXPECT_EQ(text::percentile_table(Histogram{}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace meridian::probe
