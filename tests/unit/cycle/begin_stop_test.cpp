// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/begin_stop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "unit/cycle/cutting.hpp"

namespace meridian::test::begin_stop_of_cut {
namespace {

TEST(BeginStop, TheRateFallsNoFasterThanPlansLeaveRoomForWhereFaultLimitsAreTheSame) {
  const MachineModel machine = machine_with_faults(1);
  const RateBounds bounds = fault_rate_bounds(machine, 1), own = rate_bounds(machine);
  EXPECT_EQ(bounds.slope, own.slope);
  EXPECT_EQ(bounds.curvature, own.curvature);
}

TEST(BeginStop, TheRateFallsAsFastAsTheFaultLimitsOfTheWeakestJointLet) {
  constexpr double kRatio = kRateCurvature_per_s2 / kRateSlope_per_s;
  for (const double factor : {1.5, 2.0, 4.0}) {
    for (const double share : {0.8, 1.0}) {
      MachineModel machine = machine_with_faults(factor);
      machine.joints[1].limits.velocity *= 3;  // one joint is weaker than the others
      const double more = fault_rate_bounds(machine, share).slope - rate_bounds(machine).slope;
      EXPECT_NEAR(fault_rate_bounds(machine, share).curvature - rate_bounds(machine).curvature,
                  kRatio * more, 1e-9);
      double used = 0;
      for (int i = 0; i < machine.joint_count; ++i) {
        const JointLimits& limits = machine.joints[static_cast<std::size_t>(i)].limits;
        const double a = limits.acceleration, v = limits.velocity;
        used = std::max(
            {used, (a + more * v) / (share * limits.fault_acceleration),
             (limits.jerk + 3 * more * a + kRatio * more * v) / (share * limits.fault_jerk)});
      }
      EXPECT_NEAR(used, 0.99, 1e-9) << "fault limits " << factor << ", share " << share;
    }
  }
}

TEST(BeginStop, AStopThatIsLaidOutAnewGoesOnCounting) {
  CycleState state;
  lay_out_stop(state, {0, 40, 0, 0}, {1000, 30000});
  const double first = state.stop.stopping_distance;
  state.stop.time = 0.02;
  lay_out_stop(state, {0.7, 30, -500, 0}, {1000, 30000});
  const StopLaw law({0.7, 30, -500, 0}, {1000, 30000});
  EXPECT_EQ(state.stop.time, 0);
  EXPECT_DOUBLE_EQ(state.stop.stopping_time, 0.02 + law.duration());
  EXPECT_DOUBLE_EQ(state.stop.stopping_distance, first + law.distance());
}

TEST(BeginStop, AFaultStopWithoutAuthorityGoesAlongThePlanToo) {
  Cutting one(0);
  Cycle c = one.cycle();
  begin_stop(c, StopKind::kFault);
  EXPECT_EQ(one.world.state.stop.mode, StopMode::kFaultAlongPlan);
  EXPECT_EQ(one.world.state.stop.rate_begin, 1);
}

TEST(BeginStop, AFaultStopThatHasNoMarginOfItsOwnLooksForThatOfItsKind) {
  Holding one;
  const_cast<TimePiece&>(*one.world.reader.piece()).fault_jerk = 0;
  Cycle c = one.cycle();
  begin_stop(c, StopKind::kFault);
  EXPECT_EQ(one.stop().mode, StopMode::kOnPath);
  EXPECT_EQ(one.stop().kind, StopKind::kFault);
}

TEST(BeginStop, AFaultStopKeepsTheLawOfAHoldThatBrakesLessThanItsPlanWould) {
  Holding one;
  auto& piece = const_cast<TimePiece&>(*one.world.reader.piece());
  piece.slow_velocity = 1;
  piece.a = -200'000;  // no stop from a state of such a plan bounds one from here
  const double before = one.stop().stopping_time;
  Cycle c = one.cycle();
  begin_stop(c, StopKind::kFault);
  EXPECT_EQ(one.stop().kind, StopKind::kFault);
  EXPECT_EQ(one.stop().stopping_time, before);
}

}  // namespace
}  // namespace meridian::test::begin_stop_of_cut
