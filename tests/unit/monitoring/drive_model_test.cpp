// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/drive_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
    axes.in.cycle_seen = axes.in.cycle - 1;
    axes.in.arrival_ns = static_cast<std::int64_t>(axes.in.cycle) * 1'000'000;
    const Result result = axes.monitor.check(axes.in);
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
