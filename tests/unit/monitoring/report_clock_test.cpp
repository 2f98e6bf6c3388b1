// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/report_clock.hpp"

#include <gtest/gtest.h>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

Inputs report(std::int64_t arrival_ns, std::uint64_t cycle_seen) {
  Inputs in;
  in.has_report = true;
  in.arrival_ns = arrival_ns;
  in.cycle_seen = cycle_seen;
  return in;
}

TEST(ReportClock, KnowsAReportThatItHasSeen) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  EXPECT_TRUE(clock.take(limits, report(1'000'000, 1)));
  EXPECT_FALSE(clock.take(limits, report(1'000'000, 1)));
  EXPECT_TRUE(clock.take(limits, report(2'000'000, 2)));
}

TEST(ReportClock, TakesTheLongestTimeThatAnythingSays) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  clock.take(limits, report(1'000'000, 10));
  EXPECT_EQ(clock.elapsed_s(), 0) << "of the first report nothing is known";
  clock.take(limits, report(1'100'000, 11));
  EXPECT_DOUBLE_EQ(clock.elapsed_s(), 1e-3) << "the cycle between";
  clock.take(limits, report(6'100'000, 12));
  EXPECT_DOUBLE_EQ(clock.elapsed_s(), 5e-3) << "its arrival";
  clock.take(limits, report(6'200'000, 21));
  EXPECT_DOUBLE_EQ(clock.elapsed_s(), 9e-3) << "the setpoints that were taken";
}

TEST(ReportClock, PausesBehindLostPeriods) {
  const Limits limits = test::two_axes();
  ReportClock clock;
  Inputs in = report(1'000'000, 1);
  in.periods = 3;
  clock.take(limits, in);
  EXPECT_TRUE(clock.is_paused());
  in.periods = 1;
  for (int n = 0; n < 101; ++n) clock.take(limits, in);
  EXPECT_FALSE(clock.is_paused());
}

}  // namespace
}  // namespace meridian::monitoring
