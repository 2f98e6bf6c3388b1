// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/supervise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "unit/cycle/program.hpp"

/// Where drives are after periods that they did not bridge, and how joints come back from there.
namespace meridian::test::supervised {
namespace {

/// In the middle of a cut at 100 mm/s, when `lost` periods more were lost than drives bridge.
struct Stalled : Program {
  explicit Stalled(std::uint32_t lost) {
    plan.cut({200, 0, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    run(0.6);
    world.in.lost_periods = static_cast<std::uint32_t>(machine.bridge_cycles) + lost;
    world.in.now_ns += machine.cycle_ns * (1 + world.in.lost_periods);
  }
  [[nodiscard]] Cycle cycle() {
    const Feedback& drives = world.in.feedback;
    return {machine, world.state,        world.reader, world.in, world.out,      world.dt(),
            1,       world.state.joints, world.dt(),   drives,   drives.position};
  }
};

TEST(Supervise, AfterAStallDrivesAreWhereTheyReportedSince) {
  Stalled one(20);
  one.world.in.feedback.position[0] += 0.7;
  one.world.in.feedback.arrival_ns = one.world.in.now_ns - one.machine.cycle_ns;
  EXPECT_EQ(joints_after_stall(one.cycle()), one.world.in.feedback.position);
}

TEST(Supervise, AfterAStallDrivesThatReportedBeforeItHaveGoneOnAndRampedDown) {
  for (const std::uint32_t lost : {5U, 2000U}) {  // in the ramp, and behind it
    Stalled one(lost);
    one.world.in.feedback.position[0] += 0.7;  // old, whatever it says
    const JointVector got = joints_after_stall(one.cycle());
    for (std::size_t i = 0; i < 5; ++i) {
      const double decel = one.machine.joints[i].limits.fault_acceleration;
      double speed = std::abs(one.world.state.velocity[i]), gone = 0;
      const double dt = one.world.dt() / 100;
      for (std::uint32_t n = 0; n < 100 * one.world.in.lost_periods; ++n) {
        const bool is_bridged = n < 100 * static_cast<std::uint32_t>(one.machine.bridge_cycles);
        const double next = is_bridged ? speed : std::max(0.0, speed - decel * dt);
        gone += 0.5 * (speed + next) * dt;
        speed = next;
      }
      const double expected = std::copysign(gone, one.world.state.velocity[i]);
      EXPECT_NEAR(got[i] - one.world.state.joints[i], expected, 1e-3) << lost << ", joint " << i;
    }
  }
}

TEST(Supervise, TheStopAfterAStallBeginsOnThePathAndLeadsBackToIt) {
  Stalled one(5);
  const double speed = one.world.state.on_path.ds, begin = one.world.state.on_path.s;
  Cycle c = one.cycle();
  const JointVector there = joints_after_stall(c);
  stop_from_drives(c);
  const CycleState& state = one.world.state;
  EXPECT_EQ(state.state, State::kFaultStop);
  EXPECT_EQ(state.alarm, Alarm::kPeriodsLost);
  EXPECT_GT(state.on_path.s, begin);
  EXPECT_LT(state.on_path.ds, speed);
  const double accel = one.world.reader.piece()->fault_accel;
  EXPECT_NEAR(state.on_path.dds, -accel * (1 - kReturnShare), 1e-9) << "the rest is for the return";
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(state.joints[i] + state.stop.deviation[i], there[i], 1e-9);
  }
  EXPECT_EQ(c.previous, there) << "the next setpoint is compared with where the drives are";
  EXPECT_EQ(c.periods, 1);
}

TEST(Supervise, ADwellDoesNotCountPeriodsThatDrivesDidNotBridge) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kDwell, 5);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  while (p.world.state.barrier_time == 0) p.world.run();
  const double before = p.world.state.barrier_time;
  p.world.run(static_cast<std::uint32_t>(p.machine.bridge_cycles) + 50);
  EXPECT_NEAR(p.world.state.barrier_time - before, p.world.dt(), 1e-12);
  EXPECT_EQ(p.world.now(), State::kRunning) << "at rest nothing is lost";
}

TEST(Supervise, JointsComeBackInsideTheirShareOfTheFaultLimits) {
  const JointLimits limits = bench_machine().joints[0].limits;
  for (const double deviation : {1e-4, 0.01, 0.5, -20.0}) {
    CycleState state;
    state.stop.deviation[0] = deviation;
    state.stop.deviation_time = time_to_return(limits, deviation);
    const int steps = 4000;
    const double dt = state.stop.deviation_time / steps;
    double velocity = 0, used = 0, accel = 0;
    for (int n = 0; n < steps; ++n) {
      state.joints = state.velocity = {};
      state.stop.time = n * dt;
      add_deviation(state, 1);
      const double now = (state.velocity[0] - velocity) / dt;
      used = std::max({used, std::abs(state.velocity[0]) / limits.velocity,
                       n > 0 ? std::abs(now) / limits.fault_acceleration : 0,
                       n > 1 ? std::abs(now - accel) / dt / limits.fault_jerk : 0});
      velocity = state.velocity[0];
      accel = now;
    }
    EXPECT_LE(used, 1.01 * kReturnShare) << deviation;
    EXPECT_GT(used, 0.95 * kReturnShare) << deviation;
  }
}

TEST(Supervise, JointsComeBackNoFasterThanTheDrivesOfAStage) {
  MachineModel machine = hybrid_machine();
  const JointVector joints{10, 20, 30, 0.2, 0.1}, deviation{0, 0.5, 0, 0.01, 0};
  const double free_s = time_to_return(machine, joints, deviation);
  JointVector beside = joints;
  for (std::size_t i = 0; i < beside.size(); ++i) beside[i] += deviation[i];
  const int drive = machine.joint_count;  // the first of the stage
  const auto n = static_cast<std::size_t>(drive);
  const double by = std::abs(limited_of(machine, beside)[n] - limited_of(machine, joints)[n]);
  machine.stage_drives[0].limits.velocity = 0.1;
  const double slow_s = time_to_return(machine, joints, deviation);
  EXPECT_NEAR(slow_s, 1.875 * 2 * by / kReturnShare / 0.1, 1e-9 * slow_s);
  EXPECT_GT(slow_s, 2 * free_s);
}

}  // namespace
}  // namespace meridian::test::supervised
