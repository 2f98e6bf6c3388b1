// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/stop_mode.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "meridian/cycle/cycle_state.hpp"

namespace meridian {
namespace {

using enum StopMode;

struct Row {
  StopEvent event;
  std::array<StopMode, kStopModeCount> to;  ///< from each mode, in their order
};

constexpr std::array<StopMode, kStopModeCount> all(StopMode mode) {
  std::array<StopMode, kStopModeCount> to{};
  to.fill(mode);
  return to;
}

constexpr std::array<Row, kStopEventCount> kWalk = {{
    {StopEvent::kLaidOut, all(kOnPath)},
    {StopEvent::kHold, all(kHoldAlongPlan)},
    {StopEvent::kFault, all(kFaultAlongPlan)},
    {StopEvent::kPlanRests, {kNone, kOnPath, kOffPath, kOffPath, kOffPath, kOffPathFromDrives}},
    {StopEvent::kPathLost, all(kOffPath)},
    {StopEvent::kDrivesWentOn, all(kOffPathFromDrives)},
    {StopEvent::kRested, all(kNone)},
}};

TEST(StopModes, EveryEventLeadsFromEveryModeWhereTheTableSays) {
  for (std::size_t event = 0; event < kWalk.size(); ++event) {
    ASSERT_EQ(static_cast<std::size_t>(kWalk[event].event), event) << "in order and whole";
    for (std::size_t mode = 0; mode < kStopModeCount; ++mode) {
      EXPECT_EQ(mode_after(static_cast<StopMode>(mode), kWalk[event].event), kWalk[event].to[mode])
          << "event " << event << ", mode " << mode;
    }
  }
}

TEST(StopModes, AreOnThePathAlongThePlanOrOffThePath) {
  for (std::size_t n = 0; n < kStopModeCount; ++n) {
    const auto mode = static_cast<StopMode>(n);
    const int kinds = (mode == kNone) + (mode == kOnPath) + is_along_plan(mode) + is_off_path(mode);
    EXPECT_EQ(kinds, 1) << "mode " << n;
  }
}

TEST(StopModes, AStopThatIsOverIsAsNew) {
  StopInProgress stop;
  EXPECT_FALSE(stop.is_active());
  stop.change(StopEvent::kHold);
  EXPECT_TRUE(stop.is_active());
  stop.change(StopEvent::kRested);
  EXPECT_EQ(stop.mode, StopInProgress{}.mode);
}

TEST(SingleBlockPhases, AnotherStopEndsABrakeAndNoRest) {
  using Phase = SingleBlock::Phase;
  for (const auto& [before, after] :
       {std::pair{Phase::kRunning, Phase::kRunning}, std::pair{Phase::kBraking, Phase::kRunning},
        std::pair{Phase::kResting, Phase::kResting}}) {
    SingleBlock single;
    single.phase = before;
    single.leave_brake();
    EXPECT_EQ(single.phase, after);
  }
}

}  // namespace
}  // namespace meridian
