// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/report_clock.hpp"

#include <gtest/gtest.h>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

constexpr std::uint32_t kBoth = 0b11;
constexpr double kSlack_s = 1e-3 * kSlackPeriods;

Inputs report(std::int64_t arrival_ns, std::uint64_t cycle_seen, int periods = 1) {
  Inputs in;
  in.has_report = true;
  in.periods = periods;
  in.arrival_ns.fill(arrival_ns);
  in.cycle_seen.fill(cycle_seen);
  return in;
}

TEST(ReportClock, KnowsAReportThatItHasSeen) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  EXPECT_EQ(clock.add(limits, report(1'000'000, 1)), kBoth);
  EXPECT_EQ(clock.add(limits, report(1'000'000, 1)), 0U);
  EXPECT_EQ(clock.add(limits, report(2'000'000, 2)), kBoth);
}

TEST(ReportClock, KnowsWhichAxisHasANewOneWhereDrivesReportInGroups) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  (void)clock.add(limits, report(1'000'000, 1));
  Inputs in = report(1'000'000, 1);
  in.arrival_ns[1] = 2'000'000;
  EXPECT_EQ(clock.add(limits, in), 0b10U);
  EXPECT_DOUBLE_EQ(clock.allowed_s(1), 1e-3 + kSlack_s);
}

TEST(ReportClock, TakesTheLongerOfArrivalsAndSetpointsThatWereTaken) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  (void)clock.add(limits, report(1'000'000, 10));
  EXPECT_EQ(clock.allowed_s(0), 0) << "of the first report nothing is known";
  (void)clock.add(limits, report(6'000'000, 11));
  EXPECT_DOUBLE_EQ(clock.allowed_s(0), 5e-3 + kSlack_s) << "its arrival";
  (void)clock.add(limits, report(6'200'000, 20));
  EXPECT_DOUBLE_EQ(clock.allowed_s(0), 9e-3 + kSlack_s) << "the setpoints that were taken";
}

TEST(ReportClock, AddsTheSilenceOfLateForAWhile) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  (void)clock.add(limits, report(1'000'000, 1));
  (void)clock.add(limits, report(41'000'000, 2, 40));
  (void)clock.add(limits, report(42'000'000, 3));
  EXPECT_DOUBLE_EQ(clock.allowed_s(0), 1e-3 + 39e-3 + kSlack_s);
  for (int n = 0; n < 110; ++n) {
    (void)clock.add(limits, report((43 + n) * 1'000'000, 4 + static_cast<std::uint64_t>(n)));
  }
  EXPECT_DOUBLE_EQ(clock.allowed_s(0), 1e-3 + kSlack_s) << "it is over";
}

}  // namespace
}  // namespace meridian::monitoring
