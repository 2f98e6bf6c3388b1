// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "property/cycle/operated_run.hpp"
#include "support/draws.hpp"

/// The cycle of a machine whose stage stands between two joints and their drives: holds, overrides
/// and FaultStops at any instant keep the limits of joints and drives, and what is sent are drive
/// coordinates.
namespace meridian::test::stage_motion {
namespace {

using test::Draw;
using test::LimitShares;
using test::ProgramRun;

constexpr std::uint64_t kSeed = 20240911;

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
  constexpr int kPrograms = test::draws(40);
  LimitShares worst;
  int done = 0;
  test::Operator random_operator;
  for (int n = 0; n < kPrograms; ++n) {
    SCOPED_TRACE(testing::Message() << "program " << n);
    Draw draw(kSeed + static_cast<std::uint64_t>(n), test::hybrid_machine());
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    (void)random_operator.operate(run, draw.random, 30);
    done += run.is_over();
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    test::expect_within_limits(run.world, 0, false, worst);
    expect_drive_coordinates(run.world);
  }
  std::printf("%d of %d programs to the end, %d holds; worst v %.6f a %.6f j %.6f\n", done,
              kPrograms, random_operator.holds, worst.v, worst.a, worst.j);
  EXPECT_GT(done, kPrograms / 4);
}

TEST(StageMotion, FaultStopsKeepTheFaultLimitsOfJointsAndDrives) {
  LimitShares worst;
  int stops = 0;
  for (int n = 0; n < test::draws(150); ++n) {
    SCOPED_TRACE(testing::Message() << "program " << n);
    Draw draw(kSeed + 1000 + static_cast<std::uint64_t>(n), test::hybrid_machine());
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const double until = draw.random.uniform(0.05, 3);
    if (!test::run_into_fault(run, until)) continue;
    const std::size_t first = run.world.records.size();
    ASSERT_TRUE(run.world.run_until(State::kFault, 10));
    ++stops;
    test::expect_within_limits(run.world, first, true, worst);
  }
  std::printf("%d FaultStops; worst v %.6f a %.6f j %.6f\n", stops, worst.v, worst.a, worst.j);
  EXPECT_GT(stops, test::draws(40));
}

}  // namespace
}  // namespace meridian::test::stage_motion
