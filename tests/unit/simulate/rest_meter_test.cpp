// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/rest_meter.hpp"

#include <gtest/gtest.h>

namespace meridian::simulate {
namespace {

constexpr double kStep_s = 1e-3;

/// From rest to `top` at constant acceleration within a second, on for `cruise_s`, to rest again.
void run_trapezoid(RestMeter& meter, double top, double cruise_s) {
  meter.rest();
  for (double t = 0.5 * kStep_s; t < 1; t += kStep_s) meter.move(top * t, kStep_s);
  for (double t = 0.5 * kStep_s; t < cruise_s; t += kStep_s) meter.move(top, kStep_s);
  for (double t = 0.5 * kStep_s; t < 1; t += kStep_s) meter.move(top * (1 - t), kStep_s);
  meter.rest();
}

TEST(RestMeter, CountsHalfOfEveryRampOfConstantAcceleration) {
  RestMeter meter;
  run_trapezoid(meter, 50, 3);
  EXPECT_NEAR(meter.lost_s(), 1, 2e-3);
  run_trapezoid(meter, 8, 0);
  EXPECT_NEAR(meter.lost_s(), 2, 4e-3);
}

TEST(RestMeter, CountsNothingOfASlowStretchBetweenTwoRests) {
  RestMeter slowed;
  const auto half = [&](double from, double to) {
    for (int n = 0; n < 1000; ++n) {
      slowed.move(from + (to - from) * (n + 0.5) / 1000, kStep_s);
    }
  };
  slowed.rest();
  half(0, 50);
  half(50, 10);  // a bend
  half(10, 30);
  half(30, 0);
  slowed.rest();
  EXPECT_NEAR(slowed.lost_s(), 1, 2e-3);
}

TEST(RestMeter, CountsNoTimeInWhichPlanTimeStands) {
  RestMeter meter;
  run_trapezoid(meter, 50, 1);
  const double lost = meter.lost_s();
  meter.rest();
  for (int n = 0; n < 1000; ++n) meter.move(20, 0);
  meter.rest();
  EXPECT_EQ(meter.lost_s(), lost);
}

}  // namespace
}  // namespace meridian::simulate
