// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/progress.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "service/protocol/time_table.hpp"

namespace meridian::stream {
namespace {

TEST(TimeTable, KnowsTheTimeBeforeEveryBlock) {
  TimeTable times;
  for (int i = 0; i < 100; ++i) times.append(0.5);
  EXPECT_EQ(times.blocks(), 100u);
  EXPECT_DOUBLE_EQ(times.total_s(), 50);
  EXPECT_DOUBLE_EQ(times.before(0), 0);
  EXPECT_DOUBLE_EQ(times.before(37), 18.5);
  EXPECT_DOUBLE_EQ(times.before(100), 50);
  EXPECT_DOUBLE_EQ(times.before(1000), 50);
}

TEST(TimeTable, StaysSmallAndNearlyExactForLongPrograms) {
  TimeTable times;
  double sum = 0;
  std::vector<double> before;
  for (int i = 0; i < 100'000; ++i) {
    before.push_back(sum);
    const double time_s = 1e-3 * (1 + i % 7);
    times.append(time_s);
    sum += time_s;
  }
  for (std::size_t i = 0; i < before.size(); i += 37) {
    ASSERT_NEAR(times.before(i), before[i], 0.05) << i;
  }
}

TEST(TimeTable, IsEmptyForAProgramThatWasNotRead) {
  const TimeTable times;
  EXPECT_EQ(times.before(5), 0);
}

dds::Status status(State state, std::uint64_t block) {
  dds::Status seen;
  seen.state = state;
  seen.block = block;
  return seen;
}

TEST(Progress, StretchesWhatIsLeftByWhatHasRun) {
  TimeTable times;
  for (int i = 0; i < 100; ++i) times.append(1);
  ProgressMeter meter(times);
  static_cast<void>(meter.look(status(State::kRunning, 0), 0));
  const ProgressView view = meter.look(status(State::kRunning, 25), 50'000'000'000);
  EXPECT_DOUBLE_EQ(view.fraction, 0.25);
  ASSERT_TRUE(view.to_go_s);
  EXPECT_DOUBLE_EQ(*view.to_go_s, 150);
}

TEST(Progress, DoesNotCountTheTimeInHeld) {
  TimeTable times;
  for (int i = 0; i < 100; ++i) times.append(1);
  ProgressMeter meter(times);
  static_cast<void>(meter.look(status(State::kRunning, 0), 0));
  static_cast<void>(meter.look(status(State::kRunning, 50), 50'000'000'000));
  const ProgressView view = meter.look(status(State::kHeld, 50), 500'000'000'000);
  ASSERT_TRUE(view.to_go_s);
  EXPECT_DOUBLE_EQ(*view.to_go_s, 50);
}

TEST(Progress, IsUnderWayFromTheApproachToTheLastBlockAndInStopsOnTheWay) {
  ProgressMeter meter(TimeTable{});
  const auto is_active = [&](State state) { return meter.look(status(state, 0), 0).is_active; };
  for (const State state : {State::kApproaching, State::kRunning, State::kHolding, State::kHeld,
                            State::kStarving, State::kStarved, State::kAborting}) {
    EXPECT_TRUE(is_active(state)) << static_cast<int>(state);
  }
  for (const State state : {State::kOff, State::kEnabling, State::kReady, State::kLoaded,
                            State::kDisabling, State::kFaultStop, State::kFault}) {
    EXPECT_FALSE(is_active(state)) << static_cast<int>(state);
  }
}

TEST(Progress, CallsRapidWhatIsAndNoCut) {
  ProgressMeter meter(TimeTable{});
  dds::Status seen = status(State::kRunning, 3);
  seen.motion = MotionKind::kCut;
  EXPECT_FALSE(meter.look(seen, 0).is_rapid) << "of no tip feed: the axis alone turns";
  seen.motion = MotionKind::kRapid;
  EXPECT_TRUE(meter.look(seen, 0).is_rapid);
  seen.motion = MotionKind::kApproach;
  EXPECT_TRUE(meter.look(seen, 0).is_rapid);
  seen.feed_programmed_mm_per_min = 1000;
  EXPECT_FALSE(meter.look(seen, 0).is_rapid) << "down to the part at approach feed";
}

TEST(Progress, SaysNothingAboutTimeBeforeAnythingRan) {
  ProgressMeter meter(TimeTable{});
  EXPECT_FALSE(meter.look(status(State::kLoaded, 0), 0).to_go_s);
}

}  // namespace
}  // namespace meridian::stream
