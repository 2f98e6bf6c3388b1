// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "integration/drawn_program.hpp"
#include "meridian/kinematics/soft_limits.hpp"

/// Programs anywhere under soft limits anywhere: preflight, planner and the guard of the cycle say
/// the same.
namespace meridian {
namespace {

/// Limits of one to three joints, each a draw of its travel.
SoftLimits drawn_limits(const MachineModel& own, test::Engine& engine) {
  SoftLimits limits;
  const int count = 1 + static_cast<int>(engine() % 3);
  for (int n = 0; n < count; ++n) {
    const auto joint = static_cast<std::uint8_t>(engine() % static_cast<unsigned>(own.joint_count));
    const double reach = own.joints[joint].is_rotary ? 4 : 300;
    std::uniform_real_distribution<double> end(0, reach);
    const JointLimits& whole = own.joints[joint].limits;
    const double home = own.joints[joint].home;
    (void)limits.apply({LimitsWord::kSet, joint, std::max(whole.travel_min, home - end(engine)),
                        std::min(whole.travel_max, home + end(engine))},
                       own);
  }
  return limits;
}

TEST(DrawnLimits, AreSeenByPreflightPlannerAndGuardAlike) {
  constexpr unsigned kSeed = 20261127;
  const auto narrow = [](const MachineModel& own, test::Engine& engine) {
    const SoftLimits limits = drawn_limits(own, engine);
    MachineModel model = own;
    shrink_travel(model, travel_under(limits, own));
    return model;
  };
  test::DrawnCounts counts;
  test::check_drawn_programs(
      kSeed, narrow,
      [](const test::DrawnRun& drawn) {
        const auto& records = drawn.is_done ? drawn.run.records : drawn.whole.records;
        EXPECT_EQ(test::is_stopped(records, drawn.narrowed, Alarm::kTravel), !drawn.is_done)
            << drawn.run.report.reason;
      },
      counts);
  EXPECT_GT(counts.run, counts.programs / 10);
  EXPECT_GT(counts.refused_first, counts.programs / 10);
}

}  // namespace
}  // namespace meridian
