// SPDX-License-Identifier: Apache-2.0
#include "meridian/monitoring/mode.hpp"

#include <gtest/gtest.h>

#include "unit/monitoring/monitored_axes.hpp"

namespace meridian::monitoring {
namespace {

Mode mode_after(ModeTracker& tracker, Motion motion, bool is_open, int cycles = 1) {
  const Limits limits = test::two_axes();
  Inputs in;
  in.motion = motion;
  in.is_guard_open = is_open;
  Mode mode = Mode::kOff;
  for (int n = 0; n < cycles; ++n) mode = tracker.find(limits, in);
  return mode;
}

TEST(MonitoringMode, FollowsTheMotionBehindShutGuards) {
  ModeTracker tracker;
  EXPECT_EQ(mode_after(tracker, Motion::kOff, false), Mode::kOff);
  EXPECT_EQ(mode_after(tracker, Motion::kHoming, false), Mode::kOff);
  EXPECT_EQ(mode_after(tracker, Motion::kRest, false), Mode::kStandstill);
  EXPECT_EQ(mode_after(tracker, Motion::kJog, false), Mode::kAutomatic);
  EXPECT_EQ(mode_after(tracker, Motion::kProgram, false), Mode::kAutomatic);
}

TEST(MonitoringMode, AllowsNothingButAJogWithAnOpenGuard) {
  ModeTracker tracker;
  EXPECT_EQ(mode_after(tracker, Motion::kRest, true), Mode::kStandstill);
  EXPECT_EQ(mode_after(tracker, Motion::kJog, true), Mode::kSetUp);
  EXPECT_EQ(mode_after(tracker, Motion::kProgram, true), Mode::kStandstill);
  EXPECT_EQ(mode_after(tracker, Motion::kHoming, true), Mode::kStandstill);
  EXPECT_EQ(mode_after(tracker, Motion::kProgram, false), Mode::kAutomatic) << "it is shut";
}

TEST(MonitoringMode, GivesWhatMovedWhenTheGuardOpenedTimeToStop) {
  ModeTracker tracker;
  EXPECT_EQ(mode_after(tracker, Motion::kProgram, false), Mode::kAutomatic);
  EXPECT_EQ(mode_after(tracker, Motion::kProgram, true, 1999), Mode::kAutomatic);
  EXPECT_EQ(mode_after(tracker, Motion::kProgram, true, 2), Mode::kStandstill);
}

TEST(MonitoringMode, GivesNoTimeOnceTheMachineHasComeToRest) {
  ModeTracker tracker;
  EXPECT_EQ(mode_after(tracker, Motion::kJog, true), Mode::kAutomatic);
  EXPECT_EQ(mode_after(tracker, Motion::kRest, true), Mode::kStandstill);
  EXPECT_EQ(mode_after(tracker, Motion::kJog, true), Mode::kSetUp);
}

}  // namespace
}  // namespace meridian::monitoring
