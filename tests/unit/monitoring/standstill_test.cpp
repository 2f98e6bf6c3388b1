// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/standstill.hpp"

#include <gtest/gtest.h>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

using test::MonitoredAxes;

/// Reports of axis 0 that creep by 5 mm/s, for half a second, whatever the setpoint says.
Result creep(MonitoredAxes& axes) {
  Result result;
  for (int n = 0; n < 500 && result.finding == Finding::kNone; ++n) {
    axes.in.measured[0] += 5e-3;
    result = axes.cycle();
  }
  return result;
}

TEST(Standstill, FindsAnAxisThatCreepsOutOfItsWindow) {
  MonitoredAxes axes;
  axes.in.motion = Motion::kRest;
  EXPECT_EQ(axes.run(1).finding, Finding::kNone);
  const Result result = creep(axes);
  EXPECT_EQ(result.finding, Finding::kStandstill);
  EXPECT_EQ(result.axis, 0);
  EXPECT_NEAR(result.value, 1, 6e-3);
}

TEST(Standstill, WaitsUntilTheDrivesHaveSettled) {
  MonitoredAxes axes;
  axes.in.motion = Motion::kRest;
  axes.in.commanded[0] = 4;
  axes.in.measured[0] = 0;
  for (int n = 0; n < 480; ++n) {
    axes.in.measured[0] += 4.0 / 480;
    ASSERT_EQ(axes.cycle().finding, Finding::kNone);
  }
}

TEST(Standstill, SaysNothingOfAMachineThatMoves) {
  MonitoredAxes axes;
  axes.in.motion = Motion::kProgram;
  EXPECT_EQ(axes.run(0.9, 100).finding, Finding::kNone);
}

TEST(Standstill, HoldsTheProgramBehindAnOpenGuard) {
  MonitoredAxes axes;
  axes.in.motion = Motion::kRest;
  axes.in.is_guard_open = true;
  EXPECT_EQ(axes.run(0.1).finding, Finding::kNone);
  axes.in.motion = Motion::kProgram;
  EXPECT_EQ(axes.run(1, 5).finding, Finding::kStandstill);
}

}  // namespace
}  // namespace meridian::monitoring
