// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meridian/cycle/guard.hpp"
#include "support/cycle_world.hpp"
#include "support/machines.hpp"
#include "support/made_plan.hpp"

/// The cycle of a machine with an actuator stage: what comes from the drives and what goes to them.
namespace meridian {
namespace {

using test::CycleWorld;

const ToolPose kBegin{
    {0, 0, 0}, {std::sin(0.3) * std::cos(0.4), std::sin(0.3) * std::sin(0.4), std::cos(0.3)}};
const PathLimits kStageLimits{50, 500, 5000};
constexpr std::size_t kFirst = 1, kSecond = 3;  // where the sliders stand in drive order

/// A machine that cuts along x, `seconds` after its start.
struct Cut {
  explicit Cut(double seconds) {
    world.in.feedback.position = drives_of(machine, plan.joints());
    EXPECT_TRUE(world.enable());
    plan.cut({80, 30, 0}, kStageLimits);
    EXPECT_TRUE(world.run_until(State::kLoaded, 1));
    world.command(Verb::kStart);
    world.run_for(seconds);
  }
  MachineModel machine = test::hybrid_machine();
  CycleWorld world{machine};
  test::MadePlan plan{machine, *world.port, kBegin};
};

TEST(StageCycle, TheFirstEnabledSetpointIsTheFeedbackBitForBit) {
  int rounded = 0;
  for (int n = 0; n < 20; ++n) {
    CycleWorld world(test::hybrid_machine());
    const JointVector at{1.1, -237.7 - 1.37 * n, 3.3, -311.3 + 0.77 * n, 0.1};
    world.in.feedback.position = at;
    ASSERT_TRUE(world.enable());
    for (const CycleRecord& record : world.records) EXPECT_EQ(record.setpoint.position, at);
    EXPECT_EQ(world.records.back().joints, joints_of(world.machine, at));
    rounded += drives_of(world.machine, world.records.back().joints) != at;
  }
  EXPECT_GT(rounded, 5) << "there and back never rounds: nothing was shown";
}

TEST(StageCycle, SetpointsAreDriveCoordinatesOfTheJoints) {
  Cut cut(0.4);
  const CycleRecord& record = cut.world.records.back();
  ASSERT_EQ(record.state, State::kRunning);
  const JointVector u = drives_of(cut.machine, record.joints);
  EXPECT_EQ(record.setpoint.position, u);
  EXPECT_NE(u[kFirst], record.joints[kFirst]);
  const JointVector before = (cut.world.records.end() - 2)->setpoint.position;
  for (const std::size_t i : {kFirst, kSecond}) {
    EXPECT_NEAR((u[i] - before[i]) / cut.world.dt(), record.setpoint.velocity[i], 0.5);
    EXPECT_GT(std::abs(record.setpoint.velocity[i]), 1);
  }
}

TEST(StageCycle, DrivesThatJointsCannotHaveAreNoFeedback) {
  CycleWorld world(test::hybrid_machine());
  world.in.feedback.position[kSecond] = world.in.feedback.position[kFirst] + 301;  // x > 1
  world.run();
  world.command(Verb::kEnable);
  EXPECT_EQ(static_cast<Refusal>(world.last(EventCode::kRefused).x), Refusal::kNoFeedback);
}

TEST(StageCycle, ADriveThatLagsIsNamedBehindTheJoints) {
  Cut cut(0.2);
  cut.world.machine.stage_drives[1].limits.following_error = 0.5;
  cut.world.in.feedback.position[kSecond] += 0.6;
  cut.world.run();
  const Event alarm = cut.world.last(EventCode::kAlarm);
  EXPECT_EQ(static_cast<Alarm>(alarm.a), Alarm::kFollowingError);
  EXPECT_EQ(alarm.b, 6U);
  EXPECT_NEAR(alarm.x, 0.6, 1e-9);
}

TEST(StageCycle, LostPeriodsLeadBackToThePathInsideTheLimitsOfTheDrives) {
  Cut cut(0.4);
  const std::size_t first = cut.world.records.size();
  for (const std::size_t i : {kFirst, kSecond}) cut.world.in.feedback.position[i] += 0.02;
  cut.world.run(static_cast<std::uint32_t>(cut.machine.bridge_cycles) + 1);
  ASSERT_EQ(cut.world.now(), State::kFaultStop);
  ASSERT_TRUE(cut.world.run_until(State::kFault, 2));
  const auto& r = cut.world.records;
  const double dt = cut.world.dt();
  for (std::size_t n = first + 3; n < r.size(); ++n) {
    for (int i = 0; i < 2; ++i) {
      const std::size_t k = i == 0 ? kFirst : kSecond;
      const JointLimits& limits = cut.machine.stage_drives[static_cast<std::size_t>(i)].limits;
      const auto u = [&](std::size_t back) { return r[n - back].setpoint.position[k]; };
      ASSERT_LE(std::abs(u(0) - u(1)) / dt, limits.velocity);
      ASSERT_LE(std::abs(u(0) - 2 * u(1) + u(2)) / (dt * dt), limits.fault_acceleration);
      ASSERT_LE(std::abs(u(0) - 3 * u(1) + 3 * u(2) - u(3)) / (dt * dt * dt),
                limits.fault_jerk * (1 + 1e-6));
    }
  }
}

TEST(StageCycle, TheGuardStopsADriveBeyondTravelOrTooFast) {
  MachineModel machine = test::hybrid_machine();
  const JointVector last{0, 0, 0, 0.5, 0};
  JointVector next = last;
  next[1] += 0.2;
  EXPECT_EQ(check(machine, next, {}, last, 1e-3).alarm, Alarm::kNone);
  const double u1 = drives_of(machine, next)[kFirst];
  machine.stage_drives[0].limits.travel_min = u1 + 0.1;
  GuardVerdict verdict = check(machine, next, {}, last, 1e-3);
  EXPECT_EQ(verdict.alarm, Alarm::kTravel);
  EXPECT_EQ(verdict.joint, 5);
  EXPECT_EQ(verdict.value, u1);
  EXPECT_EQ(check(machine, last, {}, next, 1e-3).alarm, Alarm::kNone) << "back inside";
  machine = test::hybrid_machine();
  machine.stage_drives[1].limits.velocity = 100;
  verdict = check(machine, next, {}, last, 1e-3);
  EXPECT_EQ(verdict.alarm, Alarm::kStep);
  EXPECT_EQ(verdict.joint, 6);
  EXPECT_NEAR(std::abs(verdict.value), 0.2, 1e-9);
}

TEST(StageCycle, AStopBesideThePathKeepsTheDrivesFaultLimits) {
  Cut cut(0.4);
  const std::size_t first = cut.world.records.size();
  JointVector velocity{};
  velocity[3] = 0.8;  // the table turns: the stage is curved
  velocity[1] = 40;
  const double dt = cut.world.dt();
  CycleState& state = cut.world.state;
  CycleWorld& w = cut.world;
  Cycle c{w.machine, state,        w.reader, w.in,          w.out,       dt,
          1,         state.joints, dt,       w.in.feedback, state.joints};
  state.stop = stop_off_path(w.machine, state.joints, velocity);
  ASSERT_FALSE(is_stop_over(state.stop));
  std::vector<LimitedVector> at;
  for (double t = 0; !is_stop_over(state.stop) && t < 2; t += dt) {
    ASSERT_TRUE(follow_stop(c));
    at.push_back(limited_of(w.machine, state.joints));
  }
  ASSERT_GT(at.size(), 4U) << first;
  for (std::size_t n = 2; n < at.size(); ++n) {
    for (std::size_t i = 5; i < 7; ++i) {
      const double a = (at[n][i] - 2 * at[n - 1][i] + at[n - 2][i]) / (dt * dt);
      ASSERT_LE(std::abs(a), w.machine.stage_drives[i - 5].limits.fault_acceleration * 1.05);
    }
  }
}

}  // namespace
}  // namespace meridian
