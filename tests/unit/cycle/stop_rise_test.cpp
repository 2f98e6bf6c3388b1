// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "meridian/cycle/stop/stop_motion.hpp"
#include "support/machines.hpp"
#include "unit/cycle/program.hpp"

/// A stop while the motion gains speed lets go of its acceleration first: it gets no faster by that
/// than the planner reckons with.
namespace meridian::test::stop_rise {
namespace {

constexpr StopMargin kMargin{3000, 120'000};

/// On the way up to 100 mm/s, with one cycle to call functions of.
struct GainingSpeed : Program {
  GainingSpeed() {
    plan.cut({200, 0, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    run(0.05);
    EXPECT_EQ(world.now(), State::kRunning);
    planned = state_at(*world.reader.piece(), world.state.piece_time);
    EXPECT_GT(planned.ds, 10);
    EXPECT_GT(planned.dds, 500);
  }
  [[nodiscard]] Cycle cycle() {
    const Feedback& drives = world.in.feedback;
    return {machine, world.state,        world.reader, world.in, world.out,      world.dt(),
            1,       world.state.joints, world.dt(),   drives,   drives.position};
  }
  /// Of a stop at the planned speed and `ds` more, with `factor` times the planned acceleration.
  [[nodiscard]] bool is_planned(double ds, double factor, const StopMargin& margin = kMargin) {
    return is_rise_planned(cycle(), StopKind::kHold,
                           {planned.s, planned.ds + ds, factor * planned.dds, 0}, margin);
  }

  PathState planned;
};

TEST(StopRise, IsPlannedUpToTheAccelerationOfThePlan) {
  GainingSpeed one;
  EXPECT_TRUE(one.is_planned(0, 0.5));
  EXPECT_TRUE(one.is_planned(0, 1)) << "as the plan itself";
  EXPECT_FALSE(one.is_planned(0, 1.01)) << "the rate still rises";
}

TEST(StopRise, CountsTheSpeedThatAStopRisesToAndNotTheAccelerationAlone) {
  GainingSpeed one;
  const double rise = 0.5 * one.planned.dds * one.planned.dds / kMargin.jerk;  // mm/s
  EXPECT_FALSE(one.is_planned(0.01, 1)) << "from more speed to more speed";
  EXPECT_FALSE(one.is_planned(-2.9 * rise, 2)) << "twice the acceleration, four times the rise";
}

/// Where the path bends it would come faster than the planner reckons with.
TEST(StopRise, IsNotPlannedWhereTheStopEndsFarther) {
  GainingSpeed one;
  const double rise = 0.5 * one.planned.dds * one.planned.dds / kMargin.jerk;
  EXPECT_FALSE(one.is_planned(-3.1 * rise, 2)) << "no faster, but it lets go later";
  EXPECT_TRUE(one.is_planned(-0.9 * one.planned.ds, 2));
  const auto distance = [&](double ds, double factor) {
    return StopLaw({0, one.planned.ds + ds, factor * one.planned.dds, 0}, kMargin).distance();
  };
  double low = -0.9 * one.planned.ds, high = 0;
  for (int n = 0; n < 50; ++n) {
    const double ds = 0.5 * (low + high);
    (distance(ds, 2) > distance(0, 1) ? high : low) = ds;
  }
  EXPECT_TRUE(one.is_planned(low - 1e-3, 2));
  EXPECT_FALSE(one.is_planned(high + 1e-3, 2));
}

TEST(StopRise, IsNoQuestionWhereNoSpeedIsGainedOrAStopHasNoMargin) {
  GainingSpeed one;
  EXPECT_TRUE(one.is_planned(50, 0));
  EXPECT_TRUE(one.is_planned(50, -1));
  EXPECT_TRUE(one.is_planned(50, 2, {}));
}

TEST(StopRise, AStopThatWouldRiseFasterThanPlannedGoesAlongThePlan) {
  for (const StopKind kind : {StopKind::kHold, StopKind::kFault}) {
    for (const bool is_faster : {false, true}) {
      GainingSpeed one;
      one.world.state.on_path.dds = (is_faster ? 1.01 : 1) * one.planned.dds;
      Cycle c = one.cycle();
      begin_stop(c, kind);
      EXPECT_EQ(is_along_plan(one.world.state.stop.mode), is_faster);
    }
  }
}

TEST(StopRise, AStopLeavesThePlanOnlyWhereItRisesNoFasterThanPlanned) {
  for (const bool is_faster : {false, true}) {
    GainingSpeed one;
    one.world.state.stop.change(StopEvent::kHold);
    one.world.state.on_path.dds = (is_faster ? 1.01 : 1) * one.planned.dds;
    EXPECT_EQ(authority_to_leave_plan(one.cycle()).jerk > 0, !is_faster);
  }
}

}  // namespace
}  // namespace meridian::test::stop_rise
