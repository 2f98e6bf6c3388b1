// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "property/rt/program_run.hpp"

/// The cycle of a machine whose stage stands between two joints and their drives: holds, overrides
/// and FaultStops at any instant keep the limits of joints and drives, and what is sent are drive
/// coordinates.
namespace meridian {
namespace {

using test::Draw;
using test::LimitShares;
using test::ProgramRun;

constexpr std::uint64_t kSeed = 20240911;
constexpr double kLimit = 1 + 1e-6;

/// Every setpoint is the stage of its joints, and its velocity the derivative of its position.
void expect_drive_coordinates(const test::CycleWorld& world) {
  const auto& r = world.records;
  double worst = 0, worst_velocity = 0;
  for (std::size_t n = 2; n < r.size(); ++n) {
    const JointVector u = drives_of(world.machine, r[n - 1].joints);
    for (int i = 0; i < world.machine.joint_count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      worst = std::max(worst, std::abs(u[k] - r[n - 1].setpoint.position[k]));
      const double central = (r[n].setpoint.position[k] - r[n - 2].setpoint.position[k]) / 2;
      const JointLimits& limits = drive_spec(world.machine, i).limits;
      const double bound = limits.fault_jerk * std::pow(world.dt(), 3) / 6 + 1e-11;
      worst_velocity = std::max(
          worst_velocity, std::abs(central - r[n - 1].setpoint.velocity[k] * world.dt()) / bound);
    }
  }
  EXPECT_LE(worst, 1e-11);
  EXPECT_LE(worst_velocity, 1.0);
}

TEST(StageMotion, HoldsAndOverridesKeepTheLimitsOfJointsAndDrives) {
  constexpr int kPrograms = 40;
  LimitShares worst;
  int holds = 0, done = 0;
  for (int n = 0; n < kPrograms; ++n) {
    Draw draw(kSeed + static_cast<std::uint64_t>(n), test::hybrid_machine());
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    double next = 0;
    for (double t = 0; t < 30 && !run.is_over(); t += run.world.dt()) {
      if (t < next) {
        run.run();
        continue;
      }
      next = t + draw.random.log_uniform(0.01, 1.0);
      if (run.world.now() == State::kHeld) {
        run.command(Verb::kResume);
      } else if (draw.random.chance(0.5)) {
        run.command(Verb::kHold);
        ++holds;
      } else {
        run.command(Verb::kFeedOverride, draw.random.uniform(0, 1.5));
      }
    }
    done += run.is_over();
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0) << "program " << n;
    const LimitShares shares = test::shares_of_limits(run.world, 0, false);
    EXPECT_LE(std::max({shares.v, shares.a, shares.j}), kLimit)
        << "program " << n << " v " << shares.v << " a " << shares.a << " j " << shares.j;
    worst.take(shares);
    expect_drive_coordinates(run.world);
  }
  std::printf("%d of %d programs to the end, %d holds; worst v %.6f a %.6f j %.6f\n", done,
              kPrograms, holds, worst.v, worst.a, worst.j);
  EXPECT_GT(done, kPrograms / 4);
}

TEST(StageMotion, FaultStopsKeepTheFaultLimitsOfJointsAndDrives) {
  LimitShares worst;
  int stops = 0;
  for (int n = 0; n < 150; ++n) {
    Draw draw(kSeed + 1000 + static_cast<std::uint64_t>(n), test::hybrid_machine());
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const double until = draw.random.uniform(0.05, 3);
    for (double t = 0; t < until && !run.is_over(); t += run.world.dt()) run.run();
    if (run.is_over()) continue;
    run.world.in.feedback.fault_mask = 1;
    const std::size_t first = run.world.records.size();
    ASSERT_TRUE(run.world.run_until(State::kFault, 10));
    ++stops;
    const LimitShares shares = test::shares_of_limits(run.world, first, true);
    EXPECT_LE(std::max({shares.v, shares.a, shares.j}), kLimit)
        << "program " << n << " v " << shares.v << " a " << shares.a << " j " << shares.j;
    worst.take(shares);
  }
  std::printf("%d FaultStops; worst v %.6f a %.6f j %.6f\n", stops, worst.v, worst.a, worst.j);
  EXPECT_GT(stops, 40);
}

}  // namespace
}  // namespace meridian
