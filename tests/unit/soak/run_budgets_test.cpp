// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/run_budgets.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <string>

#include "service/host/soak/report/soak_report.hpp"
#include "service/host/soak/watch/host_credit.hpp"
#include "service/host/soak/watch/overrun_excuse.hpp"
#include "service/host/soak/watch/time_slices.hpp"

namespace meridian::soak {
namespace {

using Verdict = CheckResult::Verdict;
constexpr std::int64_t kUs = 1000, kMilli = 1'000'000;

[[nodiscard]] Histogram histogram(std::int64_t value_ns, int count) {
  Histogram out;
  for (int i = 0; i < count; ++i) out.record(value_ns);
  return out;
}

TEST(TimeSlices, GiveTheFirstAndTheLastQuarterOfARunOfAnyLength) {
  for (const int length_s : {40, 300, 4000}) {
    SCOPED_TRACE(length_s);
    TimeSlices slices;
    for (int i = 0; i < length_s; ++i) {
      const bool is_first = 4 * i < length_s, is_last = 4 * i >= 3 * length_s;
      slices.add(i + 0.5, "a", histogram(is_first ? 10 : is_last ? 30 : 20, 10));
    }
    const Histogram first = slices.first_quarter(length_s)["a"];
    const Histogram last = slices.last_quarter(length_s)["a"];
    EXPECT_EQ(first.max_ns(), 10) << "nothing of what came later";
    EXPECT_EQ(last.percentile_ns(0), 30) << "nothing of what was before";
    for (const Histogram& one : {first, last}) {
      EXPECT_GE(one.count(), static_cast<std::uint64_t>(length_s) * 10 / 8) << "half of a quarter";
      EXPECT_LE(one.count(), static_cast<std::uint64_t>(length_s) * 10 / 4);
    }
  }
}

TEST(HostCredit, ExplainsWhatTheWitnessSawAndNoMore) {
  HostCredit credit(kMilli, 5 * kMilli);
  EXPECT_EQ(credit.explain(0, 3), 0U) << "nobody was away";
  credit.add(1, histogram(900 * kUs, 100));
  EXPECT_EQ(credit.explain(1, 3), 0U) << "less than a period";
  Histogram stall = histogram(20 * kMilli, 1);
  credit.add(2, stall);
  EXPECT_EQ(credit.explain(2, 20), 20U) << "its lateness";
  EXPECT_LE(credit.explain(2, 100), 4U) << "half a nap, and a period that it touched";
  EXPECT_EQ(credit.explain(2, 1), 0U) << "it is used up";
  credit.add(3, stall);
  EXPECT_EQ(credit.explain(14, 1), 0U) << "long ago";
}

TEST(HostCredit, LeavesACycleItsOwnLossUnderAWitnessThatIsALittleLate) {
  HostCredit credit(kMilli, 5 * kMilli);
  std::uint64_t explained = 0;
  for (int second = 0; second < 60; ++second) {
    credit.add(second, histogram(300 * kUs, 2));  // one of a hundred naps of 5 ms
    explained += credit.explain(second, 10);      // one of a hundred periods
  }
  EXPECT_EQ(explained, 0U);
}

TEST(OverrunExcuse, ReachesNoFartherThanTwoSecondsFromAStall) {
  OverrunExcuse excuse;
  EXPECT_EQ(excuse.explain(1, 5, false), 0U);
  EXPECT_EQ(excuse.explain(2, 3, true), 8U) << "the stall was seen when it was over";
  EXPECT_EQ(excuse.explain(2.1, 0, true), 0U) << "once";
  EXPECT_EQ(excuse.explain(10, 7, false), 0U);
  EXPECT_EQ(excuse.explain(13, 1, true), 1U) << "seven were long before";
}

/// Eight minutes at 1 kHz with all rights in which all was well.
class RunBudgetsTest : public testing::Test {
 protected:
  RunBudgetsTest() {
    report_.elapsed_s = 480;
    report_.is_host_watched = true;
    report_.cycles_run = 480'000;
    Life life;
    life.has_first = true;
    life.first.threads = {{.name = "cycle", .id = 7, .policy = SCHED_FIFO, .priority = 80},
                          {.name = "publisher", .id = 8, .policy = SCHED_FIFO, .priority = 70},
                          {.name = "log", .id = 9}};
    life.ready = life.first.threads;
    life.last = life.first;
    life.last.process.locked_mib = 59;
    life.last.cycles_run = 470'000;
    life.last.threads[0].voluntary_switches = 470'000;
    report_.lives.push_back(life);
    measure_all(0, 0, 0);
  }

  void measure(int quarter, std::int64_t computation_ns, std::int64_t lateness_ns,
               std::int64_t bare_ns, int count = 120'000) {
    const double at_s = 60 + 120 * quarter;
    report_.slices.add(at_s, "cycle computation", histogram(computation_ns, count));
    report_.slices.add(at_s, "wake-up lateness", histogram(lateness_ns, count));
    report_.slices.add(at_s, kBareThread, histogram(bare_ns, count / 5));
  }

  /// All four quarters anew, each so much slower than the one before it, µs.
  void measure_all(int computation_us, int lateness_us, int bare_us) {
    report_.slices = {};
    for (int quarter = 0; quarter < 4; ++quarter) {
      measure(quarter, (2 + computation_us * quarter) * kUs, (20 + lateness_us * quarter) * kUs,
              (10 + bare_us * quarter) * kUs);
    }
  }

  [[nodiscard]] CheckResult of(const std::string& budget) const {
    for (const CheckResult& one : check_run(report_)) {
      if (one.budget.name == budget) return one;
    }
    ADD_FAILURE() << "no result of " << budget;
    return {};
  }
  void expect(const std::string& budget, Verdict verdict, const std::string& why = "") const {
    const CheckResult one = of(budget);
    EXPECT_EQ(one.verdict, verdict) << budget << ": " << one.figure << " " << one.why;
    EXPECT_NE(one.why.find(why), std::string::npos) << one.why;
    EXPECT_EQ(one.why.empty(), verdict != Verdict::kNotChecked) << "a reason where one is due";
  }

  /// Of what breaks `budget` the host accounts for `too_few`, then for `enough`; then nobody
  /// watches it.
  void expect_less_what_host_did(const std::string& budget, std::uint64_t& by_host,
                                 std::uint64_t too_few, std::uint64_t enough) {
    by_host = too_few;
    expect(budget, Verdict::kBroken);
    by_host = enough;
    expect(budget, Verdict::kKept);
    by_host = 0;
    report_.is_host_watched = false;
    expect(budget, Verdict::kNotChecked, "not watched");
    report_.is_host_watched = true;
  }

  SoakReport report_;
};

TEST_F(RunBudgetsTest, AreAllKeptWhereAllWasWell) {
  for (const CheckResult& one : check_run(report_)) {
    EXPECT_EQ(one.verdict, Verdict::kKept) << one.budget.name << " " << one.why;
  }
  report_.finished = 1;
  EXPECT_TRUE(report_.passed()) << to_text(report_);
  report_.overruns = 1;
  EXPECT_FALSE(report_.passed()) << "a budget that is broken fails the soak";
  EXPECT_NE(to_text(report_).find("BROKEN     soak_overruns"), std::string::npos)
      << to_text(report_);
}

TEST_F(RunBudgetsTest, CountPageFaultsOfCycleAndPublisherFromReadyOn) {
  Life& life = report_.lives[0];
  life.last.threads[2].minor_faults = 5;
  expect("cycle_page_faults", Verdict::kKept);
  life.last.threads[1].major_faults = 1;
  expect("cycle_page_faults", Verdict::kBroken);
  life.ready[1].major_faults = 1;
  expect("cycle_page_faults", Verdict::kKept);
  life.last.threads[0].minor_faults = 1;
  expect("cycle_page_faults", Verdict::kBroken);
  life.last.process.locked_mib = 0;
  expect("cycle_page_faults", Verdict::kNotChecked, "memory could not be locked");
  life.ready.clear();
  expect("cycle_page_faults", Verdict::kNotChecked, "never Ready");
}

TEST_F(RunBudgetsTest, CheckTheLostPeriodsThatTheHostDoesNotAccountFor) {
  report_.periods_lost = 2000;
  expect_less_what_host_did("soak_periods_lost", report_.periods_lost_to_host, 0, 1800);
  report_.cycles_run = 20'000;
  expect("soak_periods_lost", Verdict::kNotChecked, "too short");
}

TEST_F(RunBudgetsTest, CheckTheOverrunsThatNoStallWasNear) {
  report_.overruns = 3;
  report_.host_stalls = 1;
  expect_less_what_host_did("soak_overruns", report_.overruns_by_host, 2, 3);
}

TEST_F(RunBudgetsTest, CompareComputationOfTheSameWorkAlone) {
  const auto cut = [this](int quarter, int percent) {
    report_.slices.add(60 + 120 * quarter, kCutting, histogram(1, 10 * percent));
    report_.slices.add(60 + 120 * quarter, kCutting, histogram(0, 1000 - 10 * percent));
  };
  cut(0, 60);
  cut(3, 57);
  expect("soak_computation_drift_p50", Verdict::kKept);
  report_.slices = {};
  measure(0, 2 * kUs, 20 * kUs, 10 * kUs);
  measure(3, 9 * kUs, 20 * kUs, 10 * kUs);
  cut(0, 40);
  cut(3, 60);
  expect("soak_computation_drift_p50", Verdict::kNotChecked,
         "40 % of the first quarter cut, 60 % of the last");
  expect("soak_lateness_drift_p50", Verdict::kKept);
}

TEST_F(RunBudgetsTest, CheckTheSwitchesOfACycleOfRealTimeClass) {
  Life& life = report_.lives[0];
  life.last.threads[0].voluntary_switches = 600'000;
  expect("soak_cycle_switches", Verdict::kBroken);
  life.last.threads[0].policy = SCHED_OTHER;
  expect("soak_cycle_switches", Verdict::kNotChecked, "no real-time priority");
  life.last.cycles_run = 10'000;
  expect("soak_cycle_switches", Verdict::kNotChecked, "too short");
}

TEST_F(RunBudgetsTest, FindAComputationThatGrew) {
  measure_all(2, 0, 0);
  expect("soak_computation_drift_p50", Verdict::kBroken);
  expect("soak_lateness_drift_p50", Verdict::kKept);
  report_.is_host_watched = false;
  expect("soak_computation_drift_p50", Verdict::kNotChecked, "not watched");
}

TEST_F(RunBudgetsTest, BlameTheHostWhereABareThreadDriftedToo) {
  measure_all(0, 60, 0);
  expect("soak_lateness_drift_p50", Verdict::kBroken);
  measure_all(0, 60, 60);
  expect("soak_lateness_drift_p50", Verdict::kNotChecked, "a bare thread");
}

TEST_F(RunBudgetsTest, BlameTheHostWhereItTookMoreThanHalfOfTheTail) {
  // 300 of 120 000 cycles far too late: a stall of 300 ms that a bare thread met once.
  measure(3, 2 * kUs, 5 * kMilli, 20 * kUs, 300);
  expect("soak_lateness_drift_p999", Verdict::kBroken);
  report_.slices.add(420, kBareThread, histogram(300 * kMilli, 1));
  expect("soak_lateness_drift_p999", Verdict::kNotChecked, "took the processor away for 0.2");
  expect("soak_lateness_drift_p50", Verdict::kKept);
}

TEST_F(RunBudgetsTest, SayNothingOfQuartersThatAreTooShort) {
  report_.slices = {};
  measure(0, 2 * kUs, 20 * kUs, 10 * kUs);
  measure(3, 9 * kUs, 20 * kUs, 10 * kUs, 20'000);
  expect("soak_computation_drift_p50", Verdict::kNotChecked, "fewer samples");
}

}  // namespace
}  // namespace meridian::soak
