// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/drive_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

using test::MonitoredAxes;

constexpr double kLag_s = 0.02;

Limits limits_with_a_model(double error_mm, int delay_cycles = 0) {
  Limits limits = test::two_axes();
  limits.axes[0].has_model = true;
  limits.axes[0].time_constant_s = kLag_s;
  limits.axes[0].model_error = error_mm;
  limits.axes[0].delay_cycles = delay_cycles;
  limits.axes[0].frozen = 50;
  limits.axes[0].has_window = false;
  return limits;
}

/// Ramps axis 0 up to 200 mm/s and down again, led by a drive of time constant `lag_s`, integrated
/// in small steps as no model here is; the first finding, and the largest lag.
Result ramp(MonitoredAxes& axes, double lag_s, double& largest_lag) {
  double y1 = 0, y2 = 0, u = 0;
  axes.in.motion = Motion::kProgram;
  Result first;
  for (int n = 0; n < 800; ++n) {
    const double t = n * 1e-3;
    const double speed = t < 0.1 ? 0 : 200 * std::pow(std::sin((t - 0.1) * 3.14159 / 0.7), 2);
    for (int k = 0; k < 100; ++k) {  // the setpoint that was sent last, for one period
      y2 += (y1 - y2) * 2 / lag_s * 1e-5;
      y1 += (u - y1) * 2 / lag_s * 1e-5;
    }
    axes.in.measured[0] = y2;
    largest_lag = std::max(largest_lag, std::abs(u - y2));
    u += speed * 1e-3;
    axes.in.commanded[0] = u;
    axes.in.cycle += 1;
    axes.in.cycle_seen.fill(axes.in.cycle - 1);
    axes.in.arrival_ns.fill(static_cast<std::int64_t>(axes.in.cycle) * 1'000'000);
    const Result result = axes.check();
    if (first.finding == Finding::kNone) first = result;
  }
  return first;
}

TEST(DriveModel, IsOnTheDriveWhereAConstantWouldHaveToAllowFourMillimetres) {
  MonitoredAxes axes(limits_with_a_model(0.02));
  double lag = 0;
  EXPECT_EQ(ramp(axes, kLag_s, lag).finding, Finding::kNone);
  EXPECT_GT(lag, 3.5) << "mm behind the setpoint: a constant bound is larger";
}

TEST(DriveModel, FindsADriveThatLagsAFifthMore) {
  MonitoredAxes axes(limits_with_a_model(0.5));
  double lag = 0;
  const Result result = ramp(axes, 1.2 * kLag_s, lag);
  EXPECT_EQ(result.finding, Finding::kDriveModel);
  EXPECT_EQ(result.axis, 0);
}

TEST(DriveModel, DelaysSetpointsAsTheDriveDoes) {
  MonitoredAxes right(limits_with_a_model(0.5)), delayed(limits_with_a_model(0.5, 4));
  double lag = 0;
  EXPECT_EQ(ramp(right, kLag_s, lag).finding, Finding::kNone);
  EXPECT_EQ(ramp(delayed, kLag_s, lag).finding, Finding::kDriveModel)
      << "the drive is ahead of a model that waits for four periods";
}

/// A drive of its own period beside the service: setpoints reach it up to `late_s` late and `lost`
/// of them, in every `every` cycles, never; it bridges what is missing by the last velocity.
struct Wire {
  double late_s = 0;
  int lost = 0, every = 150;
};

/// The first finding of a ramp over `wire` with a drive of `lag_s`.
Result ramp_over(const Wire& wire, MonitoredAxes& axes, double lag_s) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> late(0, std::max(wire.late_s, 1e-12));
  std::deque<std::pair<int, double>> in_flight;
  std::vector<double> at{0}, speeds{0};
  double y1 = 0, y2 = 0, target = 0, arrival_s = 0;
  int taken = 0;
  axes.in.motion = Motion::kProgram;
  axes.in.cycle = 0;
  Result first;
  for (int n = 1; n < 1600; ++n) {
    speeds.push_back(n < 100 ? 0 : 200 * std::pow(std::sin((n - 100) * 3.14159e-3 / 0.4), 2));
    at.push_back(at.back() + speeds.back() * 1e-3);
    // The drive's period ahead of the cycle: it takes what has come, or bridges.
    int newest = taken;
    for (; !in_flight.empty() && in_flight.front().second <= n * 1e-3 - 1e-9;
         in_flight.pop_front()) {
      newest = in_flight.front().first;
    }
    const auto k = static_cast<std::size_t>(newest);
    target = newest > taken ? at[k] : target + speeds[k] * 1e-3;
    taken = newest;
    for (int step = 0; step < 100; ++step) {
      y2 += (y1 - y2) * 2 / lag_s * 1e-5;
      y1 += (target - y1) * 2 / lag_s * 1e-5;
    }
    const bool is_lost = n % wire.every >= wire.every - wire.lost;
    if (is_lost) {
      ++axes.in.periods;
      continue;
    }
    axes.in.measured[0] = y2;
    axes.in.cycle = static_cast<std::uint64_t>(n - 1);  // sent in the cycle before
    axes.in.commanded[0] = at[static_cast<std::size_t>(n - 1)];
    axes.in.cycle_seen.fill(static_cast<std::uint64_t>(taken));
    axes.in.arrival_ns.fill(std::int64_t{n} * 1'000'000);
    const Result result = axes.check();
    axes.in.periods = 1;
    if (first.finding == Finding::kNone) first = result;
    arrival_s = std::max(arrival_s, n * 1e-3 + late(random));
    in_flight.emplace_back(n, arrival_s);
  }
  return first;
}

TEST(DriveModel, FindsNothingInADriveThatBridgesAndOneThatIsSlow) {
  for (const double lag_s : {0.002, 0.02, 0.1}) {
    for (const Wire& wire : {Wire{}, Wire{.late_s = 1.5e-3}, Wire{.late_s = 4e-3},
                             Wire{.lost = 1, .every = 90}, Wire{.lost = 3}, Wire{.lost = 40}}) {
      SCOPED_TRACE(testing::Message()
                   << lag_s << " s, " << wire.late_s << " s late, " << wire.lost << " lost");
      Limits limits = limits_with_a_model(0.05);
      limits.axes[0].time_constant_s = lag_s;
      MonitoredAxes axes(limits);
      EXPECT_EQ(ramp_over(wire, axes, lag_s).finding, Finding::kNone);
    }
  }
}

TEST(DriveModel, FindsAWrongLagOnAMachineThatLosesAPeriodAgainAndAgain) {
  MonitoredAxes axes(limits_with_a_model(0.5));
  const Wire wire{.lost = 1, .every = 90};
  EXPECT_EQ(ramp_over(wire, axes, 1.3 * kLag_s).finding, Finding::kDriveModel);
}

TEST(DriveModel, SaysNothingOfAnAxisThatHasNoneBesideOneThatHas) {
  MonitoredAxes axes(limits_with_a_model(0.5));
  axes.in.motion = Motion::kProgram;
  for (int n = 0; n < 300; ++n) {
    axes.in.commanded[1] = axes.in.measured[1] += 0.5e-3;
    ASSERT_EQ(axes.cycle().finding, Finding::kNone);
  }
}

TEST(DriveModel, SaysNothingWhereTheMachineFileKnowsNoLag) {
  Limits limits = limits_with_a_model(0.001);
  limits.axes[0].has_model = false;
  MonitoredAxes axes(limits);
  double lag = 0;
  EXPECT_EQ(ramp(axes, 2 * kLag_s, lag).finding, Finding::kNone);
}

}  // namespace
}  // namespace meridian::monitoring
