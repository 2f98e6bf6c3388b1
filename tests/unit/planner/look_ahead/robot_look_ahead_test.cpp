// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/robot_look_ahead.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "meridian/kinematics/tip_over_base.hpp"
#include "unit/planner/singular/wrist_path.hpp"

namespace meridian::test::robot_look_ahead {
namespace {

using wrist_path::WristPath;

ClBlock cut_to(const ToolPose& end, std::uint64_t sequence = 0) {
  ClBlock block;
  block.sequence = sequence;
  block.tip_mm = to_array(end.tip);
  block.axis = to_array(end.axis);
  return block;
}

/// A robot whose tool stands far from every singular place, and blocks of 20 mm along y, which turn
/// its yaw.
struct Course {
  Course() {
    for (int n = 1; n <= 4; ++n) {
      ToolPose end = path.pose(0);
      end.tip[1] += 20 * n;
      blocks.push_back(cut_to(end, static_cast<std::uint64_t>(n)));
    }
  }
  [[nodiscard]] int follow(const LookAheadSlack& slack = {}) const {
    const RobotStart start{path.model.tool_length_mm, path.pose(0), path.branch, path.begin_joints};
    return follow_ahead(path.model, slack, start, blocks);
  }
  [[nodiscard]] JointVector joints_behind(std::size_t block) const {
    const ToolPose end{to_vector(blocks[block].tip_mm), to_vector(blocks[block].axis)};
    return solve(path.model, path.model.tool_length_mm, end, path.branch, path.begin_joints).q;
  }

  WristPath path{0.6};
  std::vector<ClBlock> blocks;
};

TEST(RobotLookAhead, CountsTheBlocksThatTheArmCanFollow) {
  Course course;
  EXPECT_EQ(course.follow(), 4);
  course.blocks.clear();
  EXPECT_EQ(course.follow(), 0);
}

TEST(RobotLookAhead, PassesOverWhatDoesNotMoveAndEndsAtAToolChange) {
  Course course;
  course.blocks[1].kind = BlockKind::kDwell;
  EXPECT_EQ(course.follow(), 4);
  course.blocks[2].kind = BlockKind::kTool;
  EXPECT_EQ(course.follow(), 2);
}

TEST(RobotLookAhead, EndsWhereAJointLeavesItsTravel) {
  Course course;
  const double before = course.joints_behind(1)[robot::kYaw];
  const double after = course.joints_behind(2)[robot::kYaw];
  JointLimits& yaw = course.path.model.joints[robot::kYaw].limits;
  (after > before ? yaw.travel_max : yaw.travel_min) = 0.5 * (before + after);
  EXPECT_EQ(course.follow(), 2);
}

TEST(RobotLookAhead, EndsWhereThePoseIsOutOfReachOrNoPose) {
  Course far;
  far.blocks[1].tip_mm[0] = 5000;
  EXPECT_EQ(far.follow(), 1);
  Course lacking;
  lacking.blocks[3].axis = {0, 0, 0};
  EXPECT_EQ(lacking.follow(), 3);
}

TEST(RobotLookAhead, EndsWhereTheTipLeavesItsBox) {
  Course course;
  course.path.model.tip_box = {true, {-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}};
  EXPECT_EQ(course.follow(), 4);
  const MachineModel& model = course.path.model;
  const auto at = [&](std::size_t block) {
    return tip_over_base(model, model.tool_length_mm, course.joints_behind(block))[1];
  };
  const double before = at(0), after = at(1), edge = 0.5 * (before + after);
  (after > before ? course.path.model.tip_box.max : course.path.model.tip_box.min)[1] = edge;
  EXPECT_EQ(course.follow(), 1);
}

TEST(RobotLookAhead, GoesStraightThroughASingularPlaceWhereTheSlackLetsIt) {
  const WristPath path(1e-4);
  MachineModel model = path.model;
  JointLimits& roll = model.joints[robot::kRoll].limits;
  roll.travel_min = path.begin_joints[robot::kRoll] - 0.5;
  roll.travel_max =
      path.begin_joints[robot::kRoll] + 0.5;  // not for the half turn of the exact way
  const RobotStart start{model.tool_length_mm, path.pose(0), path.branch, path.begin_joints};
  const std::vector<ClBlock> blocks{cut_to(path.pose(WristPath::kLength_mm))};
  EXPECT_EQ(follow_ahead(model, {0.01, 0.002}, start, blocks), 1);
  EXPECT_EQ(follow_ahead(model, {}, start, blocks), 0);
}

TEST(RobotLookAhead, FollowsAJointHoweverFastItTurnsBesideASingularPlace) {
  for (const double beside_rad : {1e-4, 1e-8, 1e-14}) {  // half a turn in 0.1 mm, or at once
    const WristPath path(beside_rad);
    const RobotStart start{path.model.tool_length_mm, path.pose(0), path.branch, path.begin_joints};
    const std::vector<ClBlock> blocks{cut_to(path.pose(WristPath::kLength_mm))};
    EXPECT_EQ(follow_ahead(path.model, {}, start, blocks), 1) << beside_rad;
  }
}

TEST(RobotLookAhead, ComesBackOutOfASingularPlaceOnTheSideThatItWentIn) {
  const WristPath path(1e-4);
  MachineModel model = path.model;
  JointVector bent = path.begin_joints;
  const double side = std::copysign(1.0, bent[robot::kBend]);
  bent[robot::kBend] = 0.6 * side;
  JointLimits& bend = model.joints[robot::kBend].limits;
  (side > 0 ? bend.travel_min : bend.travel_max) = -0.3 * side;  // on the other side it ends
  const RobotStart start{model.tool_length_mm, path.pose(0), path.branch, path.begin_joints};
  const std::vector<ClBlock> blocks{cut_to(path.pose(10)), cut_to(path.pose(0)),
                                    cut_to(forward(model, model.tool_length_mm, bent))};
  EXPECT_EQ(follow_ahead(model, {0.01, 0.002}, start, blocks), 3);
}

}  // namespace
}  // namespace meridian::test::robot_look_ahead
