// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

TEST(RestToRestPlanner, GivesNoPathIndexTwiceToTwoProgramsOfAnEpoch) {
  const MachineModel model = test::lai_machine();
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  MotionReader reader(*port);
  reader.set_epoch(1);
  RestToRestPlanner planner(model);
  JointVector joints{};
  for (int program = 0; program < 3; ++program) {
    planner.begin(joints, model.tool_length_mm, 1);
    const ToolPose pose = forward(model, model.tool_length_mm, joints);
    ClBlock block;
    block.kind = BlockKind::kRapid;
    block.axis = to_array(pose.axis);
    for (const double way_mm : {0.0, 3.0}) {  // nothing to approach, then a single path piece
      block.tip_mm = to_array(pose.tip + Vector3(way_mm, 0, 0));
      ASSERT_EQ(planner.plan(block, writer).status, PlanStatus::kOk);
    }
    int moves = 0;
    while (reader.advance() != nullptr) {
      ASSERT_NE(reader.path(), nullptr);
      if (moves++ == 0) {
        EXPECT_EQ(reader.path()->joints_begin, joints) << "the path of another program";
      }
    }
    EXPECT_GT(moves, 0);
    joints = planner.joints();
  }
}

}  // namespace
}  // namespace meridian
