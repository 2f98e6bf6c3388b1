// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "property/planner/smooth_trace.hpp"
#include "service/config/machine_file.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// What is planned where a robot passes its singular places: joints inside their limits, or a
/// refusal.
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
    ClBlock block;
    block.kind = BlockKind::kCut;
    block.tip_mm = {4.0 * (kBlocks / 2 - n), beside_mm, 700};
    block.axis = {0, 0, 1};
    block.feed = 50;
    block.feed_meaning = FeedMeaning::kTip;
    block.sequence = static_cast<std::uint64_t>(n);
    block.line = static_cast<std::uint32_t>(n + 1);
    blocks.push_back(block);
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

/// Where the cycle comes to rest: the planner of a refused program does not say.
JointVector end_of(const MachineModel& model, const Trace& trace, JointVector joints) {
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const TimePiece& piece = trace.times[n];
    if (piece.kind != TimeKind::kMove) continue;
    for (const double share : {0.5, 1.0}) {
      const double s = state_at(piece, share * piece.duration).s;
      joints = joints_at(model, trace.paths[n], s, joints).q;
    }
  }
  return joints;
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
    if (beside_mm > 20) {
      EXPECT_EQ(trace.last.status, PlanStatus::kOk);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, RobotPasses,
                         testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test
