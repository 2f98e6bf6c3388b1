// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/picture/machine_posture.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/picture/path_picture.hpp"
#include "support/scratch.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::inspect {
namespace {

class PostureOfEveryShipped : public testing::TestWithParam<std::string> {
 protected:
  const MachineModel model_ = config::load_machine(test::shipped_file(GetParam()));

  /// Anywhere in the middle half of travel.
  [[nodiscard]] JointVector draw(std::mt19937_64& random) const {
    JointVector q{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(model_.joint_count); ++i) {
      const JointSpec& joint = model_.joints[i];
      const double low = joint.is_endless ? -3 : joint.limits.travel_min;
      const double high = joint.is_endless ? 3 : joint.limits.travel_max;
      q[i] = std::uniform_real_distribution<double>(0.75 * low + 0.25 * high,
                                                    0.25 * low + 0.75 * high)(random);
    }
    return q;
  }
  /// Programs that lead from one drawn place to the next.
  [[nodiscard]] std::vector<ProgramPose> program(int poses) const {
    std::vector<ProgramPose> out;
    std::mt19937_64 random(11);
    const JointVector middle = draw(random);
    for (int n = 0; n < poses; ++n) {
      JointVector q = middle;
      q[0] += model_.joints[0].is_rotary ? 0.01 * n : 2.0 * n;
      out.push_back({forward(model_, model_.tool_length_mm, q), model_.tool_length_mm,
                     static_cast<std::uint32_t>(n + 1)});
    }
    return out;
  }
};

TEST_P(PostureOfEveryShipped, TipAndWorkpieceAreAsFarApartAsForwardKinematicsSays) {
  std::mt19937_64 random(5);
  for (int n = 0; n < 50; ++n) {
    const JointVector q = draw(random);
    const MachinePosture posture = posture_at(model_, q, model_.tool_length_mm);
    const ToolPose pose = forward(model_, model_.tool_length_mm, q);
    EXPECT_NEAR((posture.tip - posture.table.back()).norm(), pose.tip.norm(), 1e-9);
    EXPECT_NEAR((posture.tip - posture.head.back()).norm(), model_.tool_length_mm, 1e-9);
  }
}

TEST_P(PostureOfEveryShipped, RodsKeepTheirLengthAndLeadFromTheRailsToTheTable) {
  const ActuatorStage& stage = model_.stage;
  std::mt19937_64 random(6);
  for (int n = 0; n < 50; ++n) {
    const JointVector q = draw(random);
    const MachinePosture posture = posture_at(model_, q, model_.tool_length_mm);
    ASSERT_EQ(posture.stage.has_value(), has_stage(model_));
    if (!posture.stage || stage.kind != StageKind::kTwoSlider || !stage::is_in_reach(stage, q)) {
      continue;
    }
    for (std::size_t k = 0; k < posture.stage->pin.size(); ++k) {
      EXPECT_NEAR((posture.stage->pin[k] - posture.stage->slider[k]).norm(), stage.rod_mm, 1e-9);
      EXPECT_NEAR((posture.stage->pin[k] - posture.stage->centre).norm(), stage.radius_mm, 1e-9);
    }
  }
}

TEST_P(PostureOfEveryShipped, PlacesOfAProgramHaveItsBeginAndItsEnd) {
  const auto poses = program(40);
  const auto postures = postures_along(model_, poses, 9);
  ASSERT_TRUE(postures) << postures.error();
  EXPECT_LE(postures->size(), 9U);
  EXPECT_GE(postures->size(), 5U);
  EXPECT_EQ(postures->front().line, 1U);
  EXPECT_EQ(postures->back().line, 40U);
  for (const MachinePosture& posture : *postures) {
    const ToolPose& asked = poses[posture.line - 1].pose;
    EXPECT_LT((forward(model_, model_.tool_length_mm, posture.joints).tip - asked.tip).norm(),
              1e-6);
  }
}

TEST_P(PostureOfEveryShipped, IsDrawn) {
  const auto postures = postures_along(model_, program(40), 9);
  ASSERT_TRUE(postures);
  const test::Scratch file(".svg");
  const auto error = draw_along(model_, *postures, file.path());
  EXPECT_FALSE(error) << *error;
  EXPECT_GT(std::filesystem::file_size(file.path()), 20'000U);
}

INSTANTIATE_TEST_SUITE_P(Machines, PostureOfEveryShipped,
                         testing::ValuesIn(test::shipped_machines()), test::test_name);

TEST(MachinePosture, APoseWithoutJointsIsNamedByItsLine) {
  const MachineModel robot = config::load_machine(test::shipped_file("robot-6r"));
  const std::vector<ProgramPose> poses{
      {{Vector3(1e5, 0, 0), Vector3::UnitZ()}, robot.tool_length_mm, 12}};
  const auto postures = postures_along(robot, poses, 9);
  ASSERT_FALSE(postures);
  EXPECT_EQ(postures.error().rfind("line 12: ", 0), 0U) << postures.error();
}

}  // namespace
}  // namespace meridian::inspect
