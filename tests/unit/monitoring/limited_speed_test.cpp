// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "meridian/monitoring/speed_window.hpp"
#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

using test::MonitoredAxes;

constexpr double kSetUpSpeed = 2000.0 / 60;  // mm/s

MonitoredAxes jogged_with_an_open_guard() {
  MonitoredAxes axes;
  axes.in.is_guard_open = true;
  axes.in.motion = Motion::kRest;
  (void)axes.cycle();
  axes.in.motion = Motion::kHand;
  return axes;
}

TEST(LimitedSpeed, LetsTheHandMoveTheTipWithTwoMetresAMinute) {
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
  axes.in.motion = Motion::kHand;
  EXPECT_EQ(axes.run(0.3, 250).finding, Finding::kNone);
}

TEST(LimitedSpeed, IsNoFasterBehindReportsThatCameTogether) {
  MonitoredAxes axes = jogged_with_an_open_guard();
  EXPECT_EQ(axes.run(0.12, kSetUpSpeed).finding, Finding::kNone);
  for (int late = 0; late < 10; ++late) {  // reports of ten periods before: nothing new comes
    axes.in.commanded[0] += kSetUpSpeed * 1e-3;
    ++axes.in.cycle;
    ASSERT_EQ(axes.monitor.check(axes.in).finding, Finding::kNone);
  }
  EXPECT_EQ(axes.run(0.12, kSetUpSpeed).finding, Finding::kNone);
}

}  // namespace
}  // namespace meridian::monitoring
