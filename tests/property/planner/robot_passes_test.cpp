// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "property/planner/random_programs.hpp"
#include "property/planner/singular_passes.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// A robot whose yaw and shoulder have room for it passes its base axis however near.
namespace meridian::test {
namespace {

constexpr double kRounding = 1e-6;

class RobotPasses : public testing::TestWithParam<Transition> {};

/// The tool upright over the base axis of a robot that can reach behind it: along x, `beside_mm`
/// off the axis, in steps of 4 mm that end on the axis itself.
std::vector<ClBlock> over_the_base(double beside_mm) {
  constexpr int kBlocks = 30;
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= kBlocks; ++n) {
    blocks.push_back(
        cut_block(n, {Vector3(4.0 * (kBlocks / 2 - n), beside_mm, 700), Vector3(0, 0, 1)}));
  }
  end_program(blocks);
  return blocks;
}

MachineModel reaching_robot() {
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  for (const std::size_t joint : {robot::kYaw, robot::kShoulder}) {
    robot.joints[joint].limits.travel_min = units::rad_from_deg(-200);
    robot.joints[joint].limits.travel_max = units::rad_from_deg(200);
  }
  return robot;
}

TEST_P(RobotPasses, OverTheBaseAxisKeepTheLimitsOfEveryJoint) {
  const MachineModel robot = reaching_robot();
  for (const double beside_mm : {0.0, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 30.0}) {
    SCOPED_TRACE(beside_mm);
    const auto blocks = over_the_base(beside_mm);
    const JointVector start = joints_of(robot, blocks[0]);
    SmoothTrace trace = plan_smooth(robot, blocks, start, {GetParam(), 0, 0}, true);
    trace.joints = end_of(robot, trace, start);
    const LimitUse use = measure_limits(robot, sample(robot, trace, 1e-3, 0.5, start), 1e-3);
    EXPECT_LT(std::max({use.v, use.a, use.j}), 1 + kRounding) << use.where;
    EXPECT_EQ(trace.last.status, PlanStatus::kOk);
    EXPECT_LT(trace.duration_s(), 60) << "it creeps";
  }
}

TEST_P(RobotPasses, AreReportedByTheNameOfTheSingularity) {
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  const auto reasons_of = [&](const SingularPass& singular, double beside) {
    const auto blocks = singular.program(Pass::kThrough, beside);
    const auto trace =
        plan_smooth(robot, blocks, joints_of(robot, blocks[0]), {GetParam(), 0, 0}, true);
    std::set<RelaxedReason> reasons;
    for (const RelaxedAxis& relaxed_axis : trace.relaxed_axes) reasons.insert(relaxed_axis.reason);
    return reasons;
  };
  for (const RelaxedReason reason : reasons_of(WristPass(robot, 1), units::rad_from_deg(0.05))) {
    EXPECT_TRUE(reason == RelaxedReason::kThroughWrist || reason == RelaxedReason::kPastWrist)
        << name_of(reason);
  }
  const auto at_both = reasons_of(BothPass(robot, 1), 0.01);
  EXPECT_TRUE(at_both.contains(RelaxedReason::kThroughBoth) ||
              at_both.contains(RelaxedReason::kPastBoth));
}

INSTANTIATE_TEST_SUITE_P(Every, RobotPasses,
                         testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test
