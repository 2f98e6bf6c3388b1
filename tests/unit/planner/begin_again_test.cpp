// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "meridian/planner/smooth_planner.hpp"
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
    for (const double distance_mm : {0.0, 3.0}) {  // nothing to approach, then a single path piece
      block.tip_mm = to_array(pose.tip + Vector3(distance_mm, 0, 0));
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

class FarTurn final : public RewindTrial {
 public:
  [[nodiscard]] bool fits(const RewindTarget& target) const noexcept override {
    return target.turns < -1;
  }
};

TEST(RestToRestPlanner, TurnsTheRedundantJointBackToTheBestWindingThatFitsWhatFollows) {
  MachineModel model = test::lai_machine();  // C two turns either way
  model.rewind_policy = RewindPolicy::kRetract;
  model.rewind_retract_mm = 20;
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  RestToRestPlanner planner(model);
  JointVector joints{};
  joints[3] = 12;
  joints[4] = 0.3;  // off the pole
  planner.begin(joints, model.tool_length_mm, 1);
  ClBlock block;
  block.sequence = 7;
  const PlanResult result = planner.rewind(block, {3, 13}, FarTurn{}, writer);
  EXPECT_EQ(result.status, PlanStatus::kOk);
  EXPECT_EQ(result.rewind.turns, -3) << "no block is known, and there is the most room";
  EXPECT_NEAR(planner.joints()[3], 12 - 3 * kTurn_rad, 1e-12);
}

/// Nobody waits for a block that will not come to hear of one that was refused.
TEST(SmoothPlanner, TellsAtOnceOfARefusalThatItFindsWithoutABlock) {
  const MachineModel model = test::lai_machine();
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  SmoothPlanner planner(model);
  planner.begin(JointVector{}, model.tool_length_mm, 1);
  ClBlock block;
  block.kind = BlockKind::kRapid;
  block.sequence = 3;
  block.tip_mm = {5000, 0, 0};  // farther than any slide goes
  block.axis = {0, 0, 1};
  ASSERT_EQ(planner.plan(block, writer).status, PlanStatus::kOk) << "more may come to look at";
  EXPECT_EQ(planner.advance(writer).status, PlanStatus::kOk);
  planner.look_no_further();
  const PlanResult found = planner.advance(writer);
  EXPECT_EQ(found.status, PlanStatus::kRefused);
  EXPECT_EQ(found.reject.sequence, 3U);
  EXPECT_EQ(found.reject.code, RejectCode::kTravel);
  EXPECT_EQ(planner.plan(block, writer).status, PlanStatus::kRefused);
}

}  // namespace
}  // namespace meridian
