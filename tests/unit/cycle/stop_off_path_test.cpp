// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/stop_off_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "unit/cycle/cutting.hpp"

namespace meridian::test::off_path {
namespace {

TEST(StopOffPath, OffThePathJointsRestTogetherOnTheirLinesInsideTheirFaultLimits) {
  MachineModel machine = machine_with_faults(2);
  for (JointSpec& joint : machine.joints) joint.limits.fault_acceleration *= 0.2;  // it binds
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
  double used = 0, used_jerk = 0;
  JointVector before = velocity, earlier = velocity;
  for (int n = 1; n <= 2000; ++n) {
    state.stop.time = n * dt;
    put_off_path(state, machine.joint_count);
    for (std::size_t i = 0; i < 5; ++i) {
      const double share = velocity[i] / velocity[0];
      EXPECT_NEAR(state.velocity[i], share * state.velocity[0], 1e-9) << "on one line";
      EXPECT_NEAR(state.joints[i] - at[i], share * (state.joints[0] - at[0]), 1e-9);
      const double accel = std::abs(state.velocity[i] - before[i]) / dt;
      used = std::max(used, accel / machine.joints[i].limits.fault_acceleration);
      const double jerk = std::abs(state.velocity[i] - 2 * before[i] + earlier[i]) / (dt * dt);
      if (n > 1) used_jerk = std::max(used_jerk, jerk / machine.joints[i].limits.fault_jerk);
    }
    earlier = before;
    before = state.velocity;
  }
  EXPECT_TRUE(is_stop_over(state.stop));
  EXPECT_EQ(state.velocity[0], 0);
  EXPECT_LE(used, 1 + 1e-9);
  EXPECT_GT(used, 0.999) << "and as soon as they can";
  EXPECT_LE(used_jerk, 1 + 1e-6);
  EXPECT_GT(used_jerk, 0.99);
}

/// Where the drives of a stage have less than the joints, the stop lasts as long as they need.
TEST(StopOffPath, OffThePathTheDrivesOfAStageKeepTheirFaultLimitsToo) {
  for (const bool is_jerk_tight : {false, true}) {
    MachineModel machine = hybrid_machine();
    for (JointSpec& joint : machine.joints) {
      joint.limits.fault_acceleration = 1e7;
      joint.limits.fault_jerk = 1e10;
    }
    for (JointSpec& drive : machine.stage_drives) {
      drive.limits.fault_acceleration = is_jerk_tight ? 1e6 : 800;
      drive.limits.fault_jerk = is_jerk_tight ? 40'000 : 1e9;
    }
    const JointVector at{20, 30, 200, 0.2, 0.3}, velocity{15, -10, 12, 0.02, 0.03};
    CycleState state;
    state.stop = stop_off_path(machine, at, velocity);
    constexpr int kSteps = 400;
    const double dt = duration_of(state.stop) / kSteps;
    ASSERT_GT(dt, 1e-6);
    std::array<LimitedVector, kSteps + 1> drives;
    for (int n = 0; n <= kSteps; ++n) {
      state.stop.time = n * dt;
      put_off_path(state, machine.joint_count);
      drives[static_cast<std::size_t>(n)] = limited_of(machine, state.joints);
    }
    double used = 0;
    for (int i = machine.joint_count; i < limited_count(machine); ++i) {
      const JointLimits& limits = limited_spec(machine, i).limits;
      for (std::size_t n = 3; n < drives.size(); ++n) {
        const auto q = [&](std::size_t back) { return drives[n - back][i]; };
        const double accel = std::abs(q(0) - 2 * q(1) + q(2)) / (dt * dt);
        const double jerk = std::abs(q(0) - 3 * q(1) + 3 * q(2) - q(3)) / (dt * dt * dt);
        used = std::max({used, accel / limits.fault_acceleration, jerk / limits.fault_jerk});
      }
    }
    EXPECT_LE(used, 1 + 1e-3) << is_jerk_tight;
    EXPECT_GT(used, 0.9) << is_jerk_tight;
  }
}

/// The drives of the stage at `n` of `steps` equal parts of a stop.
std::array<LimitedVector, 401> drives_along(const MachineModel& machine, CycleState& state) {
  std::array<LimitedVector, 401> drives;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    state.stop.time = duration_of(state.stop) * static_cast<double>(n) / 400;
    put_off_path(state, machine.joint_count);
    drives[n] = limited_of(machine, state.joints);
  }
  return drives;
}

/// A fast turn bends the motion of the drives by itself: deceleration and its share add to the
/// jerk.
TEST(StopOffPath, OffThePathTheDrivesOfAStageKeepTheirJerkWhereAFastTurnBendsTheirMotion) {
  MachineModel machine = hybrid_machine();
  for (JointSpec& joint : machine.joints) {
    joint.limits.fault_acceleration = 1e7;
    joint.limits.fault_jerk = 1e10;
  }
  for (const double turn : {-0.8, -0.3, 0.3, 0.8}) {
    for (const double jerk : {4000.0, 10'000.0}) {
      SCOPED_TRACE(testing::Message() << turn << " " << jerk);
      for (JointSpec& drive : machine.stage_drives) {
        drive.limits.fault_acceleration = 800;
        drive.limits.fault_jerk = jerk;
      }
      CycleState state;
      state.stop = stop_off_path(machine, {20, 30, 200, 0.1, 0.3}, {0, 0, 0, turn, 0});
      const auto drives = drives_along(machine, state);
      const double dt = duration_of(state.stop) / 400;
      for (int i = machine.joint_count; i < limited_count(machine); ++i) {
        for (std::size_t n = 3; n < drives.size(); ++n) {
          const double third =
              drives[n][i] - 3 * drives[n - 1][i] + 3 * drives[n - 2][i] - drives[n - 3][i];
          EXPECT_LE(std::abs(third) / (dt * dt * dt), jerk * (1 + 1e-3));
        }
      }
    }
  }
}

/// Of what the curvature takes more than three quarters of, a quarter is used: the stop ends.
TEST(StopOffPath, BesideAStageAQuarterOfALimitIsUsedWhereItsCurvatureLeavesLess) {
  MachineModel machine = hybrid_machine();
  const JointVector at{20, 30, 200, 0.1, 0.3}, direction{0, 0, 0, 0.8, 0};
  constexpr double kStep_s = 1e-4;
  const auto drive_at = [&](double t, int i) {
    JointVector q = at;
    q[3] += t * direction[3];
    return limited_of(machine, q)[i];
  };
  for (std::size_t n = 0; n < kStageDrives; ++n) {
    const int i = machine.joint_count + static_cast<int>(n);
    const double after = drive_at(kStep_s, i), before = drive_at(-kStep_s, i);
    const double rate = std::abs(after - before) / (2 * kStep_s);
    const double bend = std::abs(after - 2 * drive_at(0, i) + before) / (kStep_s * kStep_s);
    for (const double share : {0.1, 0.5, 0.7, 0.8, 2.0}) {  // of the limit, taken by curvature
      for (JointSpec& drive : machine.stage_drives) {
        drive.limits.fault_acceleration = drive.limits.fault_jerk = 1e9;
      }
      const double limit = bend / share;
      machine.stage_drives[n].limits.fault_acceleration = limit;
      const StopMargin margin = authority_beside_stage(machine, at, direction, {1e9, 1e12});
      EXPECT_NEAR(margin.accel * rate / limit, std::max(1 - share, 0.25), 1e-3) << share;
    }
  }
}

TEST(StopOffPath, OffThePathItIsOverAtOnceWhereNothingMoves) {
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

TEST(StopOffPath, OffThePathItBeginsWhereAndHowTheJointsMove) {
  const MachineModel machine = machine_with_faults(1);
  const JointVector at{1, 2, 3, 0.1, 0.2}, velocity{10, -20, 0, 0.1, 0};
  CycleState state;
  state.stop = stop_off_path(machine, at, velocity);
  put_off_path(state, machine.joint_count);
  EXPECT_EQ(state.joints, at);
  EXPECT_EQ(state.velocity, velocity);
}

TEST(StopOffPath, ADeviationFadesWithoutAJump) {
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

}  // namespace
}  // namespace meridian::test::off_path
