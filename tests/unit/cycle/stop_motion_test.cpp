// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/machines.hpp"
#include "unit/cycle/program.hpp"

namespace meridian::test::stop_motion {
namespace {

/// The bench machine with FaultStop limits `factor` times the others.
MachineModel machine_with_faults(double factor) {
  MachineModel machine = bench_machine();
  for (int i = 0; i < machine.joint_count; ++i) {
    JointLimits& limits = machine.joints[static_cast<std::size_t>(i)].limits;
    limits.fault_acceleration = factor * limits.acceleration;
    limits.fault_jerk = factor * limits.jerk;
  }
  return machine;
}

/// In the middle of a cut at 100 mm/s, with one cycle to call functions of.
struct Cutting : Program {
  explicit Cutting(double stop_share = 1, int barriers = 1) {
    plan.stop_share = stop_share;
    plan.cut({200, 0, 0}, kLimits);
    for (int n = 0; n < barriers; ++n)
      plan.barrier(n + 1 < barriers ? TimeKind::kDwell : TimeKind::kEnd);
    run(0.6);
    EXPECT_EQ(world.now(), State::kRunning);
  }
  [[nodiscard]] Cycle cycle() {
    const Feedback& drives = world.in.feedback;
    return {machine, world.state,        world.reader, world.in, world.out,      world.dt(),
            1,       world.state.joints, world.dt(),   drives,   drives.position};
  }
};

TEST(StopMotion, TheRateFallsNoFasterThanPlansLeaveRoomForWhereFaultLimitsAreTheSame) {
  const MachineModel machine = machine_with_faults(1);
  const RateBounds bounds = fault_rate_bounds(machine, 1), own = rate_bounds(machine);
  EXPECT_EQ(bounds.slope, own.slope);
  EXPECT_EQ(bounds.curvature, own.curvature);
}

TEST(StopMotion, TheRateFallsAsFastAsTheFaultLimitsOfTheWeakestJointLet) {
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

TEST(StopMotion, OffThePathJointsRestTogetherOnTheirLinesInsideTheirFaultLimits) {
  const MachineModel machine = machine_with_faults(2);
  const JointVector at{10, 20, 30, 0.5, -0.5};
  JointVector velocity{};
  for (std::size_t i = 0; i < 5; ++i) {
    velocity[i] = (i % 2 == 0 ? 0.9 : -0.3) * machine.joints[i].limits.velocity;
  }
  CycleState state;
  state.stop = stop_off_path(machine, at, velocity);
  ASSERT_EQ(state.stop.mode, StopMode::kOffPath);
  const double duration = duration_of(state.stop), dt = duration / 2000;
  ASSERT_GT(duration, 0.01);
  double used = 0;
  JointVector before = velocity;
  for (int n = 1; n <= 2000; ++n) {
    state.stop.time = n * dt;
    put_off_path(state, machine.joint_count);
    for (std::size_t i = 0; i < 5; ++i) {
      const double share = velocity[i] / velocity[0];
      EXPECT_NEAR(state.velocity[i], share * state.velocity[0], 1e-9) << "on one line";
      EXPECT_NEAR(state.joints[i] - at[i], share * (state.joints[0] - at[0]), 1e-9);
      const double accel = std::abs(state.velocity[i] - before[i]) / dt;
      used = std::max(used, accel / machine.joints[i].limits.fault_acceleration);
    }
    before = state.velocity;
  }
  EXPECT_TRUE(is_stop_over(state.stop));
  EXPECT_EQ(state.velocity[0], 0);
  EXPECT_LE(used, 1 + 1e-9);
  EXPECT_GT(used, 0.5) << "and as soon as they can";
}

TEST(StopMotion, OffThePathItIsOverAtOnceWhereNothingMoves) {
  const MachineModel machine = machine_with_faults(1);
  const JointVector at{1, 2, 3, 0, 0};
  EXPECT_EQ(duration_of(stop_off_path(machine, at, {})), 0);
  JointVector unknown{};
  unknown[2] = std::numeric_limits<double>::quiet_NaN();
  const StopInProgress stop = stop_off_path(machine, at, unknown, StopEvent::kDrivesWentOn);
  EXPECT_EQ(stop.mode, StopMode::kOffPathFromDrives);
  EXPECT_EQ(duration_of(stop), 0) << "a velocity that is not known moves no joint";
  EXPECT_EQ(stop.direction[2], 0);
  EXPECT_TRUE(is_stop_over(stop));
}

TEST(StopMotion, ADeviationFadesWithoutAJump) {
  CycleState state;
  state.stop.deviation = {0.8, -0.4};
  state.stop.deviation_time = 0.2;
  double last = 0.8;
  for (const double share : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 0.999}) {
    const auto at = [&](double x) {
      state.joints = state.velocity = {};
      state.stop.time = x * 0.2;
      add_deviation(state, 2);
      return state.joints;
    };
    const double ahead = at(share + 1e-6)[0], behind = at(std::max(0.0, share - 1e-6))[0];
    const JointVector here = at(share);
    EXPECT_LE(here[0], last) << share;
    EXPECT_NEAR(here[1], -0.5 * here[0], 1e-12);
    const double span = (share > 0 ? 2e-6 : 1e-6) * 0.2;
    EXPECT_NEAR(state.velocity[0], (ahead - behind) / span, 1e-3) << share;
    last = here[0];
  }
  EXPECT_LT(last, 1e-6);
  state.joints = {};
  state.stop.time = 0.2;
  add_deviation(state, 2);
  EXPECT_EQ(state.joints[0], 0) << "nothing is left";
}

TEST(StopMotion, AStopIsOverWhenItsLawAndItsDeviationAre) {
  CycleState state;
  EXPECT_TRUE(is_stop_over(state.stop)) << "none was begun";
  lay_out_stop(state, {0, 40, 0, 0}, {1000, 30000});
  EXPECT_EQ(state.stop.mode, StopMode::kOnPath);
  EXPECT_EQ(state.stop.speed_begin, 40);
  const StopLaw law({0, 40, 0, 0}, {1000, 30000});
  EXPECT_EQ(state.stop.stopping_time, law.duration());
  EXPECT_EQ(state.stop.stopping_distance, law.distance());
  state.stop.time = law.duration() - 1e-6;
  EXPECT_FALSE(is_stop_over(state.stop));
  state.stop.time = law.duration();
  EXPECT_TRUE(is_stop_over(state.stop));
  state.stop.deviation_time = law.duration() + 0.1;
  EXPECT_FALSE(is_stop_over(state.stop));
  state.stop.change(StopEvent::kHold);
  state.stop.time = 10;
  EXPECT_FALSE(is_stop_over(state.stop)) << "along the plan the plan's rest ends it";
}

TEST(StopMotion, AStopThatIsLaidOutAnewGoesOnCounting) {
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

TEST(StopMotion, OffThePathItBeginsWhereAndHowTheJointsMove) {
  const MachineModel machine = machine_with_faults(1);
  const JointVector at{1, 2, 3, 0.1, 0.2}, velocity{10, -20, 0, 0.1, 0};
  CycleState state;
  state.stop = stop_off_path(machine, at, velocity);
  put_off_path(state, machine.joint_count);
  EXPECT_EQ(state.joints, at);
  EXPECT_EQ(state.velocity, velocity);
}

TEST(StopMotion, AHoldWithoutAuthorityGoesAlongThePlanUntilItsRateIsZero) {
  Cutting one(0);
  one.world.command(Verb::kHold);
  EXPECT_EQ(one.world.state.stop.mode, StopMode::kHoldAlongPlan);
  double before = 1;
  for (int n = 0; n < 20; ++n) {
    const double rate = one.world.run().rate;
    EXPECT_LT(rate, before);
    before = rate;
  }
  EXPECT_EQ(one.world.now(), State::kHolding) << "no stop at once";
  ASSERT_TRUE(one.world.run_until(State::kHeld, 3));
  EXPECT_EQ(one.world.state.velocity, JointVector{});
  EXPECT_EQ(one.world.count(EventCode::kStopped), 1);
}

TEST(StopMotion, AFaultStopWithoutAuthorityGoesAlongThePlanToo) {
  Cutting one(0);
  Cycle c = one.cycle();
  begin_stop(c, StopKind::kFault);
  EXPECT_EQ(one.world.state.stop.mode, StopMode::kFaultAlongPlan);
  EXPECT_EQ(one.world.state.stop.rate_begin, 1);
}

/// A hold that began with a tenth of what its piece grants once it is on its way.
struct Holding : Cutting {
  Holding() {
    Cycle c = cycle();
    begin_stop(c, StopKind::kHold);
    stop() = {};
    lay_out_stop(world.state, world.state.on_path, {300, 12'000});
    stop().rate_begin = 1;
    for (int n = 0; n < 30; ++n) EXPECT_TRUE(follow_one_cycle());
  }
  [[nodiscard]] StopInProgress& stop() { return world.state.stop; }
  [[nodiscard]] bool follow_one_cycle() {
    Cycle c = cycle();
    return follow_stop(c);
  }
  /// Grants 3000 mm/s² and 120 000 mm/s³ from now on.
  void grant() {
    // A piece in force is written by the planner alone: of a test it may be written here.
    auto& piece = const_cast<TimePiece&>(*world.reader.piece());
    piece.slow_velocity = 1;
    piece.stop_accel = 3000;
    piece.stop_jerk = 120'000;
  }
};

TEST(StopMotion, AStopThatComesToMoreMarginEndsSooner) {
  Holding one, harder;
  harder.grant();
  const double time = harder.stop().stopping_time, distance = harder.stop().stopping_distance;
  ASSERT_TRUE(harder.follow_one_cycle() && one.follow_one_cycle());
  const double gained = time - harder.stop().stopping_time;
  EXPECT_EQ(one.stop().stopping_time, time);
  EXPECT_GT(gained, 0.1);
  const double begun_at = 0.03, begun_s = one.stop().law.at(begun_at).s - one.stop().law.at(0).s;
  EXPECT_NEAR(harder.stop().stopping_time, begun_at + harder.stop().law.duration(), 1e-9);
  EXPECT_NEAR(harder.stop().stopping_distance, begun_s + harder.stop().law.distance(), 1e-9);
  EXPECT_LT(harder.stop().stopping_distance, distance);
  EXPECT_NEAR(harder.stop().rate_begin, harder.stop().speed_begin / 100, 1e-9)
      << "the rate of plan time goes on from where it was";
  while (!is_stop_over(harder.stop())) ASSERT_TRUE(harder.follow_one_cycle());
  EXPECT_EQ(harder.world.state.on_path.ds, 0);
}

TEST(StopMotion, AStopBesideThePathKeepsItsLawUntilItIsBackOnIt) {
  Holding beside;
  beside.grant();
  const double time = beside.stop().stopping_time;
  beside.stop().deviation_time = beside.stop().time + 0.0025;
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(beside.follow_one_cycle());
    EXPECT_EQ(beside.stop().stopping_time, time);
  }
  ASSERT_TRUE(beside.follow_one_cycle());
  EXPECT_LT(beside.stop().stopping_time, time);
  EXPECT_EQ(beside.stop().deviation_time, 0);
}

TEST(StopMotion, AFaultStopThatHasNoMarginOfItsOwnLooksForThatOfItsKind) {
  Holding one;
  const_cast<TimePiece&>(*one.world.reader.piece()).fault_jerk = 0;
  Cycle c = one.cycle();
  begin_stop(c, StopKind::kFault);
  EXPECT_EQ(one.stop().mode, StopMode::kOnPath);
  EXPECT_EQ(one.stop().kind, StopKind::kFault);
}

TEST(StopMotion, AStopThatBeginsBesideThePathComesBackToIt) {
  Cutting one, beside;
  for (Cutting* it : {&one, &beside}) {
    Cycle c = it->cycle();
    begin_stop(c, StopKind::kHold);
    ASSERT_EQ(it->world.state.stop.mode, StopMode::kOnPath);
    if (it == &beside) {
      it->world.state.stop.deviation[1] = 0.5;
      it->world.state.stop.deviation_time = 0.02;
    }
    ASSERT_TRUE(follow_stop(c));
  }
  const CycleState &on = one.world.state, &off = beside.world.state;
  EXPECT_EQ(off.joints[0], on.joints[0]);
  EXPECT_GT(off.joints[1] - on.joints[1], 0.3) << "most of it is left";
  EXPECT_LT(off.joints[1] - on.joints[1], 0.5);
  while (!is_stop_over(off.stop)) {
    Cycle c = beside.cycle(), d = one.cycle();
    ASSERT_TRUE(follow_stop(c) && follow_stop(d));
  }
  EXPECT_EQ(off.joints, on.joints) << "nothing is left";
}

TEST(StopMotion, AHoldEndsInTheTailOfItsWindowOnlyWhereTheProgramCanGoOnFromThere) {
  Cutting open, behind(1, 4);
  for (const State state : {State::kHolding, State::kAborting, State::kFaultStop}) {
    open.world.state.state = behind.world.state.state = state;
    EXPECT_TRUE(may_keep_tail(open.cycle())) << "the planner remembers its window";
    EXPECT_EQ(may_keep_tail(behind.cycle()), state != State::kHolding)
        << "three windows later it does not: of a program that is void it need not";
  }
  behind.world.state.state = State::kHolding;
  behind.world.state.rate = RateFilter({0.1, 1});  // rests in 5 s of plan time
  behind.world.state.rate.reset(1);
  EXPECT_TRUE(may_keep_tail(behind.cycle())) << "nothing else would end the hold";
}

TEST(StopMotion, AFaultStopLeavesThePlanOnlyForALawThatSlowsDownSoAnyway) {
  Cutting one;  // at 100 mm/s, with authority for 3000 mm/s² and 120 000 mm/s³
  const StopMargin authority{3000, 120'000};
  const auto is_reckoned_at = [&](double ds, double dds) {
    one.world.state.on_path.ds = ds;
    one.world.state.on_path.dds = dds;
    return is_reckoned_with(one.cycle(), authority);
  };
  EXPECT_TRUE(is_reckoned_at(100, 0));
  EXPECT_TRUE(is_reckoned_at(80, 400)) << "where it gains speed";
  EXPECT_TRUE(is_reckoned_at(80, -2000)) << "the law would come down from 96.7 mm/s like that";
  EXPECT_FALSE(is_reckoned_at(85, -2000)) << "from more than the plan has";
  EXPECT_FALSE(is_reckoned_at(50, -3100)) << "harder than the law ever is";
}

TEST(StopMotion, AFaultStopLeavesASmoothPlanThatIsSlowForWhatLiesBetweenRestAndItsSlowMargin) {
  Cutting one;
  auto& piece = const_cast<TimePiece&>(*one.world.reader.piece());
  piece.slow_velocity = 40;
  piece.slow_fault_accel = 3000;
  piece.slow_fault_jerk = 120'000;
  piece.rest_fault_accel = 9000;
  piece.rest_fault_jerk = 900'000;
  one.world.state.stop.mode = StopMode::kFaultAlongPlan;
  one.world.state.on_path.ds = 2;
  one.world.state.on_path.dds = -100;
  EXPECT_GT(authority_to_leave_plan(one.cycle()).jerk, 200'000);
  one.world.state.on_path.dds = -3100;
  EXPECT_EQ(authority_to_leave_plan(one.cycle()).jerk, 0) << "harder than the margin lets it be";
}

TEST(StopMotion, AFaultStopKeepsTheLawOfAHoldThatBrakesLessThanItsPlanWould) {
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
}  // namespace meridian::test::stop_motion
