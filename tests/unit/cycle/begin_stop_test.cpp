// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/begin_stop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "unit/cycle/cutting.hpp"

namespace meridian::test::begin_stop_of_cut {
namespace {

TEST(BeginStop, TheRateFallsNoFasterThanPlansLeaveRoomForWhereFaultLimitsAreTheSame) {
  const MachineModel machine = machine_with_faults(1);
  const RateBounds bounds = fault_rate_bounds(machine, 1), own = rate_bounds(machine);
  EXPECT_EQ(bounds.slope, own.slope);
  EXPECT_EQ(bounds.curvature, own.curvature);
}

/// The largest share of a joint's FaultStop limits that the rate's fall by `more` takes beyond its
/// own bounds.
double used_by(const MachineModel& machine, double more) {
  constexpr double kRatio = kRateCurvature_per_s2 / kRateSlope_per_s;
  double used = 0;
  for (int i = 0; i < machine.joint_count; ++i) {
    const JointLimits& limits = machine.joints[static_cast<std::size_t>(i)].limits;
    const double a = limits.acceleration, v = limits.velocity;
    used = std::max({used, (a + more * v) / limits.fault_acceleration,
                     (limits.jerk + 3 * more * a + kRatio * more * v) / limits.fault_jerk});
  }
  return used;
}

TEST(BeginStop, TheRateFallsAsFastAsTheFaultLimitsOfTheWeakestJointLet) {
  constexpr double kRatio = kRateCurvature_per_s2 / kRateSlope_per_s;
  struct Case {
    double factor, jerk_factor;  // where there is much more jerk, acceleration binds
  };
  for (const Case& c : {Case{1.5, 1.5}, {2, 2}, {4, 4}, {2, 200}, {200, 2}}) {
    for (std::size_t weakest = 0; weakest < 5; ++weakest) {
      SCOPED_TRACE(testing::Message() << c.factor << " " << c.jerk_factor << " " << weakest);
      MachineModel machine = machine_with_faults(c.factor);
      for (JointSpec& joint : machine.joints) {
        joint.limits.fault_jerk = c.jerk_factor * joint.limits.jerk;
      }
      machine.joints[weakest].limits.velocity *= 30;
      for (const double share : {0.8, 1.0}) {
        const RateBounds bounds = fault_rate_bounds(machine, share), own = rate_bounds(machine);
        const double more = bounds.slope - own.slope;
        EXPECT_NEAR(bounds.curvature - own.curvature, kRatio * more, 1e-9);
        EXPECT_NEAR(used_by(machine, more), 0.99 * share, 1e-9) << "share " << share;
      }
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

TEST(BeginStop, AStopBeginsWhereAndHowTheMachineMovesHoweverSlow) {
  for (const double speed : {100.0, 0.5, 1e-3}) {
    Cutting one;
    one.world.state.on_path.ds = speed;
    const PathState here = one.world.state.on_path;
    Cycle c = one.cycle();
    begin_stop(c, StopKind::kHold);
    const StopInProgress& stop = one.world.state.stop;
    ASSERT_EQ(stop.mode, StopMode::kOnPath);
    EXPECT_EQ(stop.law.at(0).s, here.s);
    EXPECT_EQ(stop.law.at(0).ds, here.ds);
    EXPECT_EQ(stop.law.at(0).dds, here.dds);
    EXPECT_EQ(stop.speed_begin, speed);
  }
}

TEST(BeginStop, AStopIsOverAtOnceWhereNothingMoves) {
  Cutting on_path;
  on_path.world.state.on_path = {0, 0, 0, 0};
  Program loaded;  // no piece is in force
  const Feedback& drives = loaded.world.in.feedback;
  Cycle idle{loaded.machine,
             loaded.world.state,
             loaded.world.reader,
             loaded.world.in,
             loaded.world.out,
             loaded.world.dt(),
             1,
             loaded.world.state.joints,
             loaded.world.dt(),
             drives,
             drives.position};
  Cycle at_rest = on_path.cycle();
  for (Cycle* c : {&idle, &at_rest}) {
    for (const StopKind kind : {StopKind::kHold, StopKind::kFault}) {
      begin_stop(*c, kind);
      const StopInProgress& stop = c->state.stop;
      EXPECT_EQ(stop.mode, StopMode::kOnPath);
      EXPECT_EQ(stop.stopping_time, 0);
      EXPECT_EQ(stop.stopping_distance, 0);
      EXPECT_TRUE(is_stop_over(stop));
      c->state.stop = {};
    }
  }
}

TEST(BeginStop, AHoldThatWouldPassTheEndOfABlockThatTheRateBrakesForGoesAlongThePlan) {
  const auto mode_of = [](StopKind kind, double share) {
    Cutting one;
    CycleState& state = one.world.state;
    const TimePiece& piece = *one.world.reader.piece();
    const StopLaw law(state.on_path, authority_of(piece, kind, state.on_path));
    state.single_block.phase = SingleBlock::Phase::kBraking;
    state.single_block.time =
        time_at(piece, state.on_path.s + share * law.distance(), state.piece_time);
    Cycle c = one.cycle();
    begin_stop(c, kind);
    return state.stop.mode;
  };
  EXPECT_EQ(mode_of(StopKind::kHold, 1.01), StopMode::kOnPath);
  EXPECT_EQ(mode_of(StopKind::kHold, 0.99), StopMode::kHoldAlongPlan);
  EXPECT_EQ(mode_of(StopKind::kHold, 1), StopMode::kHoldAlongPlan) << "rounding may pass it";
  EXPECT_EQ(mode_of(StopKind::kFault, 0.99), StopMode::kOnPath) << "the program is void";
}

}  // namespace
}  // namespace meridian::test::begin_stop_of_cut
