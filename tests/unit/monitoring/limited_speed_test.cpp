// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <random>
#include <utility>

#include "meridian/monitoring/speed_window.hpp"
#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

using test::MonitoredAxes;

constexpr double kSetUpSpeed = 2000.0 / 60;  // mm/s

/// Two axes with room.
MonitoredAxes wide_axes() {
  Limits limits = test::two_axes();
  limits.axes[0].has_window = false;
  limits.axes[0].speed = limits.axes[0].drive_speed = 1e3;
  return MonitoredAxes(limits);
}

MonitoredAxes jogged_with_an_open_guard() {
  MonitoredAxes axes = wide_axes();
  axes.in.is_guard_open = true;
  axes.in.motion = Motion::kRest;
  (void)axes.cycle();
  axes.in.motion = Motion::kJog;
  return axes;
}

TEST(LimitedSpeed, LetsAJogMoveTheTipWithTwoMetresAMinute) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  EXPECT_EQ(axes.run(0.3, kSetUpSpeed).finding, Finding::kNone);
}

TEST(LimitedSpeed, FindsATipThatIsATenthFaster) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  const Result result = axes.run(0.2, 1.1 * kSetUpSpeed);
  EXPECT_EQ(result.finding, Finding::kTipSpeed);
  EXPECT_GT(result.value, kSetUpSpeed);
}

TEST(LimitedSpeed, FindsAnAxisThatIsTooFastWhereTheTipIsNot) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  Result result;
  for (int n = 0; n < 200 && result.finding == Finding::kNone; ++n) {
    axes.in.measured[1] += 0.25e-3;
    axes.in.commanded[1] = axes.in.measured[1];
    result = axes.cycle();
  }
  EXPECT_EQ(result.finding, Finding::kAxisSpeed);
  EXPECT_EQ(result.axis, 1);
}

TEST(LimitedSpeed, SaysNothingBehindShutGuards) {
  MonitoredAxes axes;
  axes.in.motion = Motion::kJog;
  EXPECT_EQ(axes.run(0.3, 250).finding, Finding::kNone);
}

TEST(LimitedSpeed, IsNoFasterBehindReportsThatCameTogether) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  EXPECT_EQ(axes.run(0.12, kSetUpSpeed).finding, Finding::kNone);
  for (int late = 0; late < 10; ++late) {  // reports of ten periods before: nothing new comes
    axes.in.commanded[0] += kSetUpSpeed * 1e-3;
    ++axes.in.cycle;
    ASSERT_EQ(axes.check().finding, Finding::kNone);
  }
  EXPECT_EQ(axes.run(0.12, kSetUpSpeed).finding, Finding::kNone);
}

/// Jogged at `speed` for two seconds, every report up to `late_s` late on its way; the first
/// finding. They overtake nobody.
Result jogged_over_a_slow_wire(double speed, double late_s) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> late(0, late_s);
  std::deque<std::pair<int, double>> in_flight;  // report, arrival in s
  Result first;
  double last_s = 0;
  for (int n = 1; n < 2000; ++n) {
    last_s = std::max(last_s, n * 1e-3 + late(random));
    in_flight.emplace_back(n, last_s);
    for (; !in_flight.empty() && in_flight.front().second <= n * 1e-3 + 1e-4;
         in_flight.pop_front()) {
      const auto& [report, arrival_s] = in_flight.front();
      axes.in.measured[0] = axes.in.tip[0] = speed * report * 1e-3;
      axes.in.arrival_ns.fill(std::llround(arrival_s * 1e9));
      axes.in.cycle_seen.fill(100 + static_cast<std::uint64_t>(report));
    }
    ++axes.in.cycle;
    const Result result = axes.check();
    if (first.finding == Finding::kNone) first = result;
  }
  return first;
}

TEST(LimitedSpeed, IsExactToATenthWhereReportsJitter) {
  for (const double late_s : {0.0, 0.5e-3, 1.5e-3, 3e-3}) {
    SCOPED_TRACE(late_s);
    EXPECT_EQ(jogged_over_a_slow_wire(kSetUpSpeed, late_s).finding, Finding::kNone);
    EXPECT_EQ(jogged_over_a_slow_wire(1.1 * kSetUpSpeed, late_s).finding, Finding::kTipSpeed);
  }
}

TEST(LimitedSpeed, IsMeasuredOverSixtyFourMilliseconds) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  int cycles = 0;
  Result result;
  for (; cycles < 500 && result.finding == Finding::kNone; ++cycles) {
    result = axes.run(1e-3, 10 * kSetUpSpeed);
  }
  EXPECT_EQ(result.finding, Finding::kTipSpeed);
  EXPECT_NEAR(cycles, 65, 2);
  EXPECT_NEAR(result.value, 10 * kSetUpSpeed * 64 / 68, 0.02 * result.value);
}

TEST(LimitedSpeed, IsWatchedOnAMachineThatLosesAPeriodAgainAndAgain) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  Result first;
  for (int n = 0; n < 400 && first.finding == Finding::kNone; ++n) {
    axes.in.periods = n % 50 == 49 ? 2 : 1;
    first = axes.run(1e-3, 1.2 * kSetUpSpeed * axes.in.periods);
  }
  EXPECT_EQ(first.finding, Finding::kTipSpeed);
}

TEST(LimitedSpeed, IsNoFasterBehindAStallOfTheHost) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  EXPECT_EQ(axes.run(0.1, kSetUpSpeed).finding, Finding::kNone);
  for (const int lost : {1, 10, 60, 100}) {
    axes.in.periods = 1 + lost;
    EXPECT_EQ(axes.run(1e-3, kSetUpSpeed * axes.in.periods).finding, Finding::kNone) << lost;
    axes.in.periods = 1;
    EXPECT_EQ(axes.run(0.2, kSetUpSpeed).finding, Finding::kNone) << lost;
  }
}

TEST(LimitedSpeed, GoesOnBehindTheRestsBetweenTwoJogs) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  Result first;
  for (int n = 0; n < 20 && first.finding == Finding::kNone; ++n) {
    axes.in.motion = Motion::kJog;
    first = axes.run(0.04, 5 * kSetUpSpeed);
    axes.in.motion = Motion::kRest;
    if (first.finding == Finding::kNone) first = axes.run(0.01);
  }
  EXPECT_EQ(first.finding, Finding::kTipSpeed) << "jerks that are shorter than the window";
}

TEST(LimitedSpeed, CountsNothingOfBeforeTheJog) {
  MonitoredAxes axes = wide_axes();
  axes.in.motion = Motion::kProgram;
  EXPECT_EQ(axes.run(0.2, 250).finding, Finding::kNone);
  axes.in.is_guard_open = true;
  axes.in.motion = Motion::kRest;
  EXPECT_EQ(axes.run(0.002).finding, Finding::kNone);
  axes.in.motion = Motion::kJog;
  EXPECT_EQ(axes.run(0.2, 10).finding, Finding::kNone);
}

}  // namespace
}  // namespace meridian::monitoring
