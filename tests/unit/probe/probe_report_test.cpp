// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/probe_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "service/host/probe/run/cyclictest.hpp"

namespace meridian::probe {
namespace {

constexpr int kTurns = 10;
constexpr std::size_t kPeriods = 1000;  // of a turn

std::vector<std::int64_t> turn_of(double us, std::size_t samples = kPeriods) {
  return std::vector<std::int64_t>(samples, static_cast<std::int64_t>(us * 1000));
}

/// A host where everything takes as long as it may, and `late_us` is the service's p99.
RateMeasurement measured(double late_us) {
  RateMeasurement m;
  m.rate_hz = 1000;
  for (int turn = 0; turn < kTurns; ++turn) {
    m.lateness.add(turn_of(late_us));
    m.bare_wake.add(turn_of(20));
    m.one_way.add(turn_of(60));
    m.bare_one_way.add(turn_of(30));
    m.bare_round_trip.add(turn_of(70));
    m.cutting_lateness.add(turn_of(late_us));
    m.cutting_one_way.add(turn_of(60));
    m.computation.add(turn_of(1.5));
  }
  m.periods = m.moving = kTurns * kPeriods;
  for (Missing* one :
       {&m.lost, &m.bare_lost, &m.cutting_lost, &m.unseen, &m.bare_unseen, &m.cutting_unseen}) {
    one->of = m.periods;
  }
  for (std::size_t i = 0; i < m.periods; ++i) {
    m.round_trip.record(90'000);
    m.wake.record(2000);
  }
  return m;
}

ProbeReport report_of(const RateMeasurement& m, bool is_target) {
  ProbeReport report;
  report.host = "host";
  report.is_target = is_target;
  report.add(m);
  return report;
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
  EXPECT_NE(too_large(options, 2000).find("327 s are what this host has room for"),
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
  m.computation = Turns("cutting: cycle computation");
  m.broken_off = "cycle 812: no feedback for 0.1 s";
  const ProbeReport report = report_of(m, false);
  EXPECT_FALSE(report.is_fit());
  EXPECT_NE(to_text(report).find("NO PROGRAM CAN BE CUT HERE: cycle 812: no feedback"),
            std::string::npos);
  EXPECT_NE(to_text(report).find("UNKNOWN cycle_computation_p50"), std::string::npos)
      << "nothing was computed";
  EXPECT_NE(to_json(report).find("\"broken_off\": \"cycle 812"), std::string::npos);
}

TEST(Probe, IsNotFitWhereACheckedBudgetIsMissed) {
  EXPECT_FALSE(report_of(measured(60), false).is_fit());
  RateMeasurement losing = measured(25);
  losing.lost.missing = 20;  // of 10 000
  EXPECT_FALSE(report_of(losing, false).is_fit());
  losing.bare_lost.missing = 20;  // the host's doing, then
  EXPECT_TRUE(report_of(losing, false).is_fit());
  RateMeasurement slow = measured(25);
  slow.computation.add(turn_of(600));
  EXPECT_FALSE(report_of(slow, false).is_fit());
}

TEST(Probe, IsNotFitWherePeriodsAreLostWhileCutting) {
  RateMeasurement losing = measured(25);
  losing.cutting_lost.missing = 20;
  const ProbeReport report = report_of(losing, false);
  EXPECT_FALSE(report.is_fit());
  EXPECT_NE(to_text(report).find("OUTSIDE cutting_periods_lost"), std::string::npos);
  losing.bare_lost.missing = 20;
  EXPECT_TRUE(report_of(losing, false).is_fit());
}

TEST(Probe, NothingMeasuredIsNotFast) {
  EXPECT_FALSE(ProbeReport{}.is_fit());
  const RateMeasurement whole = measured(25);
  struct Gap {
    const char* what;
    Turns RateMeasurement::*turns;
  };
  for (const Gap& gap : {Gap{"lateness", &RateMeasurement::lateness},
                         Gap{"bare thread", &RateMeasurement::bare_wake},
                         Gap{"transport", &RateMeasurement::one_way},
                         Gap{"bare ping", &RateMeasurement::bare_one_way},
                         Gap{"computation", &RateMeasurement::computation}}) {
    RateMeasurement m = whole;
    m.*gap.turns = Turns("emptied");
    EXPECT_FALSE(report_of(m, false).is_fit()) << gap.what;
    for (int turn = 0; turn < kTurns; ++turn) {  // half the turns have nothing to say
      (m.*gap.turns).add(turn % 2 == 0 ? std::vector<std::int64_t>{} : turn_of(1.5));
    }
    const ProbeReport report = report_of(m, false);
    EXPECT_FALSE(report.is_fit()) << gap.what;
    EXPECT_NE(to_text(report).find("5000 samples, at least 9000 wanted"), std::string::npos)
        << gap.what;
  }
}

TEST(Probe, IsNotFitWhereSetpointsDoNotCome) {
  RateMeasurement m = measured(25);
  m.unseen.missing = 20;
  EXPECT_FALSE(report_of(m, false).is_fit());
  EXPECT_NE(to_text(report_of(m, false)).find("OUTSIDE setpoints_unseen"), std::string::npos);
  m.bare_unseen.missing = 20;
  EXPECT_TRUE(report_of(m, false).is_fit());
}

TEST(Probe, ATargetHostNeedsTheRightsThatTheServiceNeeds) {
  config::RealtimeConfig wishes;
  const Rights all{.has_priority = true, .has_locked_memory = true, .has_dma_latency = true};
  EXPECT_TRUE(missing_rights(all, wishes).empty());
  EXPECT_EQ(missing_rights(Rights{}, wishes).size(), 3U);
  wishes.hold_dma_latency = wishes.lock_memory = false;
  ProbeReport report = report_of(measured(25), true);
  ASSERT_TRUE(report.is_fit()) << to_text(report);
  report.missing_rights = missing_rights(Rights{}, wishes);
  EXPECT_EQ(report.missing_rights, std::vector<std::string>{"real-time priority"});
  EXPECT_FALSE(report.is_fit());
  EXPECT_NE(to_text(report).find("NO REAL TIME: without real-time priority; a service in mode "
                                 "\"enforce\" refuses to start here"),
            std::string::npos);
  EXPECT_NE(to_json(report).find("\"missing_rights\": \"real-time priority\""), std::string::npos);
  report.is_target = false;
  EXPECT_TRUE(report.is_fit()) << "in comparison with bare programs that had none either";
}

TEST(Probe, ATargetHostIsCheckedOverEnoughTurns) {
  const auto verdict_of = [](const RateMeasurement& m) {
    const auto verdicts = check(m);
    return *std::find_if(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) {
      return verdict.budget.name == "turns_taken";
    });
  };
  RateMeasurement m = measured(25);
  EXPECT_TRUE(verdict_of(m).is_inside());
  m.lateness = Turns("five");
  for (int turn = 0; turn < kTurns / 2; ++turn) m.lateness.add(turn_of(25));
  EXPECT_FALSE(verdict_of(m).is_inside());
  EXPECT_EQ(verdict_of(m).budget.allowed(), 10);
}

TEST(Probe, ThatWasInterruptedReportsWhatThereIsAndIsNotFit) {
  RateMeasurement m = measured(25);
  m.is_interrupted = true;
  ProbeReport report = report_of(m, false);
  EXPECT_FALSE(report.is_fit());
  EXPECT_NE(to_text(report).find("INTERRUPTED"), std::string::npos);
  EXPECT_NE(to_json(report).find("\"interrupted\": true"), std::string::npos);
  report = report_of(measured(25), false);
  report.broken_off = "the service does not send setpoints";
  EXPECT_FALSE(report.is_fit());
  EXPECT_NE(to_text(report).find("BROKEN OFF: the service does not"), std::string::npos);
}

TEST(Probe, ReportedBudgetsNeverDecide) {
  RateMeasurement m = measured(25);
  for (int i = 0; i < 1'000'000; ++i) m.round_trip.record(10'000'000);
  m.cutting_one_way.add(turn_of(10'000, 1'000'000));
  const auto verdicts = check(m);
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

}  // namespace
}  // namespace meridian::probe
