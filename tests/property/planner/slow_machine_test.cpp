// SPDX-License-Identifier: Apache-2.0

/// Machines with a fraction of the acceleration and jerk: a window of cells lasts hardly longer
/// there than braking does, and the next one has to go on from close to a rest.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/optimum.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/machines.hpp"

namespace meridian::test::slow_machine {
namespace {

constexpr double kLimit = 1 + 1e-6;

struct Case {
  std::uint32_t seed;
  double acceleration, jerk;  // shares of those of the bench machine
  double max_s;               // seconds; without a plan past the rest 0.782, 2.276 and 0.374
};

MachineModel slowed(const Case& c) {
  MachineModel model = bench_machine();
  model.tolerances.pole_axis_rad = units::rad_from_deg(0.12);
  for (auto& joint : model.joints) {
    joint.limits.acceleration *= c.acceleration;
    joint.limits.jerk *= c.jerk;
  }
  return model;
}

TEST(SlowMachine, GoesOnPastTheRestOfThePlanBeforeWhereNoOtherPlanIsFound) {
  for (const Case& c : {Case{24, 0.2, 0.1, 0.70}, {6, 0.2, 0.1, 2.20}, {7, 0.3, 0.05, 0.32}}) {
    SCOPED_TRACE(testing::Message() << "seed " << c.seed);
    const MachineModel model = slowed(c);
    const bench::SpanPath path = bench::spans_of(model, HostilePath(c.seed).make(2));
    const bench::RollingTime took = bench::rolling_time(model, path, feed_settings(model));
    ASSERT_TRUE(took.is_done);
    EXPECT_LT(took.time_s, c.max_s);
    EXPECT_EQ(took.count.kept, 0) << "windows in which the plan before stood";
    const auto blocks = HostilePath(c.seed).make_program(2);
    const JointVector start = joints_of(model, blocks[0]);
    const SmoothTrace trace = plan_smooth(model, blocks, start);
    ASSERT_EQ(trace.last.status, PlanStatus::kOk);
    constexpr double kCycle_s = 250e-6;
    const LimitUse use =
        measure_limits(model, sample(model, trace, kCycle_s, 0.37, start), kCycle_s);
    EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  }
}

}  // namespace
}  // namespace meridian::test::slow_machine
