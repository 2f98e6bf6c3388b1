// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "property/planner/singular_passes.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"

/// A robot with its arm all but stretched: the elbow turns ever faster towards the edge of reach.
/// What comes near it is planned inside every limit without creeping, or its block is refused with
/// the reason, and rests inside reach.
namespace meridian::test {
namespace {

constexpr double kLimitShare = 1 + 1e-6;  // with what rounding adds
constexpr double kLongestProgram_s =
    15;                                // twice what the program takes in exact stop farther inside
constexpr double kStraight_mm = 1e-4;  // nearer to the edge the elbow would jump
constexpr double kBlock_mm = 4;
constexpr std::uint32_t kTurn = 10;  // the block that ends nearest to the edge

class EdgeOfReach : public testing::TestWithParam<Transition> {
 protected:
  EdgeOfReach() {
    config::place_workpiece(robot_, config::parse_frame("0,0,0"));
    robot_.joints[robot::kElbow].limits.travel_max = units::rad_from_deg(160);
  }

  /// The wrist point goes straight out from the shoulder until `inside_mm` ahead of the edge, in
  /// ten blocks, and then across.
  [[nodiscard]] std::vector<ClBlock> out_to(double inside_mm) const {
    const RobotKinematics& arm = robot_.robot;
    const double elevation = units::rad_from_deg(20), reach_mm = arm.upper_arm_mm + arm.forearm_mm;
    const Vector3 out(std::cos(elevation), 0, std::sin(elevation));
    const Vector3 across(-std::sin(elevation), 0, std::cos(elevation));
    const Vector3 axis(-std::sqrt(0.5), 0, std::sqrt(0.5));
    const Vector3 shoulder(0, 0, arm.shoulder_height_mm);
    std::vector<ClBlock> blocks;
    for (std::uint32_t n = 0; n <= 2 * kTurn; ++n) {
      const double distance_mm = reach_mm - inside_mm - kBlock_mm * (kTurn - std::min(n, kTurn));
      const double turned_mm = kBlock_mm * (std::max(n, kTurn) - kTurn);
      const Vector3 wrist = shoulder + distance_mm * out + turned_mm * (across - out);
      ClBlock block;
      block.kind = BlockKind::kCut;
      block.tip_mm = to_array(Vector3(wrist - (arm.wrist_mm + robot_.tool_length_mm) * axis));
      block.axis = to_array(axis);
      block.feed = 50;
      block.feed_meaning = FeedMeaning::kTip;
      block.sequence = n;
      block.line = n + 1;
      blocks.push_back(block);
    }
    end_program(blocks);
    return blocks;
  }

  MachineModel robot_ = config::load_machine(shipped_file("robot-6r"));
};

TEST_P(EdgeOfReach, IsReachedInsideEveryLimitOrRefusedWithTheReason) {
  for (const double inside_mm : {30.0, 9.0, 1.0, 0.1, 1e-2, 1e-3, 1e-6, 1e-9, 0.0, -1e-4, -1.0}) {
    SCOPED_TRACE(inside_mm);
    const auto blocks = out_to(inside_mm);
    const JointVector start = joints_of(robot_, blocks[0]);
    SmoothTrace trace = plan_smooth(robot_, blocks, start, {GetParam(), 0, 0}, true);
    trace.joints = end_of(robot_, trace, start);
    const auto setpoints = sample(robot_, trace, 1e-3, 0.5, start);
    const LimitUse use = measure_limits(robot_, setpoints, 1e-3);
    EXPECT_LT(std::max({use.v, use.a, use.j}), kLimitShare) << use.where;
    EXPECT_LT(trace.duration_s(), kLongestProgram_s) << "it creeps";
    const BlockReject& reject = trace.last.reject;
    if (trace.last.status != PlanStatus::kRefused) {
      EXPECT_GE(inside_mm, -robot_.tolerances.tip_mm) << "out of reach";
      continue;
    }
    EXPECT_LT(inside_mm, kStraight_mm) << "the elbow is not straight yet";
    EXPECT_EQ(reject.line, kTurn + 1);
    EXPECT_EQ(reject.code, inside_mm < 0 ? RejectCode::kUnreachable : RejectCode::kDiscontinuous);
    const ToolPose rest = forward(robot_, robot_.tool_length_mm, setpoints.back().q);
    const Vector3 last_good = to_vector(blocks[kTurn - 1].tip_mm);
    // Smooth, a stop trajectory that was published before the fault was known may end behind it.
    const bool is_smooth = GetParam() == Transition::kSmooth;
    const double past_mm = is_smooth ? kBlock_mm + inside_mm : robot_.tolerances.tip_mm;
    EXPECT_LT((rest.tip - last_good).norm(), past_mm);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, EdgeOfReach,
                         testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test
