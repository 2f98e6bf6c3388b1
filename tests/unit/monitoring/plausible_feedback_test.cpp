// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/plausible_feedback.hpp"

#include <gtest/gtest.h>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

using test::MonitoredAxes;

MonitoredAxes running() {
  MonitoredAxes axes;
  axes.in.motion = Motion::kProgram;
  axes.in.commanded[0] = axes.in.measured[0] = -50;
  EXPECT_EQ(axes.run(0.2, 100).finding, Finding::kNone);
  return axes;
}

TEST(PlausibleFeedback, FindsAPositionThatJumpedFartherThanTheAxisCanMove) {
  MonitoredAxes axes = running();
  axes.in.measured[0] += 3;
  const Result result = axes.cycle();
  EXPECT_EQ(result.finding, Finding::kJump);
  EXPECT_EQ(result.value, 3);
}

TEST(PlausibleFeedback, TakesReportsThatWereLateForNoJump) {
  MonitoredAxes axes = running();
  for (int late = 0; late < 20; ++late) {
    axes.in.commanded[0] += 0.3;
    ++axes.in.cycle;
    ASSERT_EQ(axes.check().finding, Finding::kNone);
  }
  axes.in.measured[0] = axes.in.commanded[0];  // 6 mm on, twenty periods later
  EXPECT_EQ(axes.cycle().finding, Finding::kNone);
}

TEST(PlausibleFeedback, TakesReportsOfBeforeAndAfterAStallForNoJump) {
  MonitoredAxes axes = running();
  axes.in.periods = 40;
  (void)axes.cycle();  // the oldest of a heap
  axes.in.periods = 1;
  axes.in.commanded[0] = axes.in.measured[0] += 10;
  EXPECT_EQ(axes.cycle().finding, Finding::kNone);
}

TEST(PlausibleFeedback, FindsAJumpOnAMachineThatLosesAPeriodAgainAndAgain) {
  MonitoredAxes axes = running();
  for (int n = 0; n < 5; ++n) {
    axes.in.periods = 2;
    EXPECT_EQ(axes.cycle().finding, Finding::kNone);
    axes.in.periods = 1;
    EXPECT_EQ(axes.run(0.05).finding, Finding::kNone);
  }
  axes.in.measured[0] += 3;
  EXPECT_EQ(axes.cycle().finding, Finding::kJump);
}

TEST(PlausibleFeedback, FindsTheJumpOfOneGroupOfDrivesWhileAnotherIsSlow) {
  MonitoredAxes axes = running();
  for (int n = 0; n < 20; ++n) {  // axis 1 reports every tenth period
    const auto arrival = axes.in.arrival_ns[1];
    const auto seen = axes.in.cycle_seen[1];
    axes.in.cycle += 1;
    axes.in.cycle_seen.fill(axes.in.cycle - 1);
    axes.in.arrival_ns.fill(static_cast<std::int64_t>(axes.in.cycle) * 1'000'000);
    if (n % 10 != 0) axes.in.arrival_ns[1] = arrival, axes.in.cycle_seen[1] = seen;
    if (n == 17) axes.in.measured[0] += 3;
    const Result result = axes.check();
    EXPECT_EQ(result.finding, n == 17 ? Finding::kJump : Finding::kNone) << n;
  }
}

TEST(PlausibleFeedback, StartsAnewAfterAHomingThatRenamesPositions) {
  MonitoredAxes axes = running();
  axes.in.motion = Motion::kHoming;
  (void)axes.cycle();
  axes.in.commanded[0] = axes.in.measured[0] = 80;
  (void)axes.cycle();
  axes.in.motion = Motion::kRest;
  EXPECT_EQ(axes.run(0.3).finding, Finding::kNone);
}

TEST(PlausibleFeedback, FindsAPositionThatStaysWhileTheSetpointGoesOn) {
  MonitoredAxes axes = running();
  Result result;
  int cycles = 0;
  for (; cycles < 100 && result.finding == Finding::kNone; ++cycles) {
    axes.in.commanded[0] += 0.1;
    result = axes.cycle();
  }
  EXPECT_EQ(result.finding, Finding::kFrozen);
  EXPECT_NEAR(cycles, 22, 2) << "after 2 mm at 100 mm/s";
}

TEST(PlausibleFeedback, TakesAnAxisThatRestsForNoFrozenOne) {
  MonitoredAxes axes = running();
  EXPECT_EQ(axes.run(1).finding, Finding::kNone);
  EXPECT_EQ(axes.run(0.2, 100).finding, Finding::kNone) << "and goes on";
}

TEST(PlausibleFeedback, FindsPositionsThatPassFasterThanTheAxisCan) {
  MonitoredAxes axes;
  axes.in.motion = Motion::kProgram;
  axes.in.commanded[0] = axes.in.measured[0] = -50;
  EXPECT_EQ(axes.run(0.1, 300).finding, Finding::kNone) << "its limit";
  EXPECT_EQ(axes.run(0.1, -300).finding, Finding::kNone);
  const Result result = axes.run(0.15, 420);
  EXPECT_EQ(result.finding, Finding::kDriveTooFast);
  EXPECT_GT(result.value, 300 * kOvershoot);
}

/// Two sliders turn a table and push it: it is slow where one of them is too fast.
TEST(PlausibleFeedback, FindsADriveThatIsTooFastWhereTheAxisIsNot) {
  monitoring::Limits limits = test::two_axes();
  limits.axes[0].speed = 900;
  MonitoredAxes axes(limits);
  axes.in.motion = Motion::kProgram;
  axes.in.commanded[0] = axes.in.measured[0] = -50;
  EXPECT_EQ(axes.run(0.1, 300).finding, Finding::kNone);
  const Result result = axes.run(0.15, -420);
  EXPECT_EQ(result.finding, Finding::kDriveTooFast);
  EXPECT_LT(result.value, -300 * kOvershoot);
  EXPECT_TRUE(is_of_drive(result.finding));
}

TEST(PlausibleFeedback, FindsAnAxisThatIsTooFastWhereItsDriveIsNot) {
  monitoring::Limits limits = test::two_axes();
  limits.axes[0].drive_speed = 900;
  limits.has_stage = true;
  MonitoredAxes axes(limits);
  axes.in.motion = Motion::kProgram;
  axes.in.commanded[0] = axes.in.measured[0] = -50;
  const Result result = axes.run(0.15, 420);
  EXPECT_EQ(result.finding, Finding::kAxisTooFast);
  EXPECT_FALSE(is_of_drive(result.finding));
}

}  // namespace
}  // namespace meridian::monitoring
