// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "property/planner/singular_passes.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/core/planner/look_ahead/robot_look_ahead.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// A robot begins a program on the solution that carries farthest through it.
namespace meridian::test {
namespace {

class RobotStarts : public testing::Test {
 protected:
  RobotStarts() { config::place_workpiece(robot_, config::parse_frame("0,0,0")); }

  /// The wrist point runs straight past the base axis, 5 mm beside it, from the azimuth of 45 deg
  /// to that of 225 deg, the tool leaning along the way: in front the yaw leaves its 170 deg,
  /// behind it runs from -135 to 45 deg.
  [[nodiscard]] std::vector<ClBlock> past_the_base_axis() const {
    constexpr int kBlocks = 20;
    constexpr double kBeside_mm = 5, kSweep_mm = 60, kHeight_mm = 1000;
    const double d = robot_.robot.wrist_mm + robot_.tool_length_mm, c = std::sqrt(0.5);
    const Vector3 forward(c, c, 0), beside(-c, c, 0), up(0, 0, 1);
    std::vector<ClBlock> blocks;
    for (int n = 0; n <= kBlocks; ++n) {
      const double along = kSweep_mm * (1 - 2.0 * n / kBlocks);
      const Vector3 wrist = along * forward + kBeside_mm * beside +
                            (robot_.robot.shoulder_height_mm + kHeight_mm) * up;
      blocks.push_back(cut_block(n, {Vector3(wrist - d * up), up}));
    }
    end_program(blocks);
    return blocks;
  }
  [[nodiscard]] int carries(int branch, const std::vector<ClBlock>& blocks) const {
    const ToolPose pose{to_vector(blocks[0].tip_mm), to_vector(blocks[0].axis)};
    auto at = solve(robot_, robot_.tool_length_mm, pose, branch, JointVector{});
    wind_into_travel(robot_, JointVector{}, at.q);
    return follow_ahead(robot_, {robot_.tolerances.tip_mm, robot_.tolerances.axis_rad},
                        {robot_.tool_length_mm, pose, branch, at.q}, std::span(blocks).subspan(1));
  }

  MachineModel robot_ = config::load_machine(shipped_file("robot-5r"));
};

TEST_F(RobotStarts, AreFollowedUntilAJointLeavesItsTravel) {
  const auto blocks = past_the_base_axis();
  const int all = static_cast<int>(blocks.size()) - 1;
  EXPECT_LT(carries(0, blocks), all);
  EXPECT_EQ(carries(robot::kBack, blocks), all);
}

TEST_F(RobotStarts, LeadThroughTheWholeProgram) {
  const auto blocks = past_the_base_axis();
  const JointVector front = joints_of(robot_, blocks[0]);
  ASSERT_GT(front[robot::kYaw], 0) << "the machine stands at the solution that leads nowhere";
  for (const Transition transition : {Transition::kSmooth, Transition::kExactStop}) {
    const SmoothTrace trace = plan_smooth(robot_, blocks, front, {transition, 0, 0}, true);
    EXPECT_EQ(trace.last.status, PlanStatus::kOk);
  }
}

/// Over the base axis itself either side of the arm leads on.
TEST_F(RobotStarts, AreFollowedOverTheBaseAxis) {
  const ShoulderPass pass(robot_, 3);
  const auto blocks = pass.program(Pass::kThrough, 0);
  const int all = static_cast<int>(blocks.size()) - 1;
  EXPECT_EQ(std::max(carries(0, blocks), carries(robot::kBack, blocks)), all);
}

}  // namespace
}  // namespace meridian::test
