// SPDX-License-Identifier: Apache-2.0
// Chains, robots and stages against 50-digit data that know none of their closed forms; made by
// generate_family.py beside this file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "golden/golden_table.hpp"
#include "meridian/kinematics/chain.hpp"
#include "meridian/kinematics/robot.hpp"
#include "meridian/kinematics/stage.hpp"

namespace meridian {
namespace {

using test::GoldenTable;

const std::string kFolder = MERIDIAN_SOURCE_DIR "/tests/golden/";

// From the size of the numbers: lengths to 2e3 mm, a few dozen roundings; an inverse solution also
// by how oblique the random axes are.
constexpr double kTip_mm = 1e-10, kAxis = 1e-14, kLinear_mm = 1e-8, kAngle_rad = 1e-10;

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

Vector3 vector_at(const GoldenTable& table, std::size_t row, std::size_t column) {
  return {table.number_at(row, column), table.number_at(row, column + 1),
          table.number_at(row, column + 2)};
}

ToolPose pose_of(const GoldenTable& table, std::size_t row) {
  const std::vector<double> v = table.numbers(row, "x_mm", 6);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

TEST(FamilyGolden, AnyChainAgreesForwardAndInverse) {
  const GoldenTable table(kFolder + "chain_pose.csv");
  ASSERT_EQ(table.size(), 60u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    std::array<ChainJoint, ChainKinematics::kChainLength> joints;
    JointVector want{};
    for (std::size_t n = 0; n < joints.size(); ++n) {
      const std::string number = std::to_string(n + 1);
      joints[n].joint = static_cast<int>(n);
      joints[n].is_rotary = table.word(row, "kind" + number) == "rotary";
      joints[n].is_table_side = table.word(row, "side" + number) == "table";
      joints[n].direction = vector_at(table, row, 9 * n + 2).normalized();
      if (joints[n].is_rotary) joints[n].point_mm = vector_at(table, row, 9 * n + 5);
      want[n] = table.number(row, "q" + number);
    }
    const auto k =
        describe_chain(joints, vector_at(table, row, 45).normalized(), vector_at(table, row, 48));
    ASSERT_TRUE(k.has_value()) << k.error();
    const double tool = table.number(row, "tool_mm");
    const ToolPose pose = pose_of(table, row), got = chain::forward(*k, tool, want);
    EXPECT_LT((got.tip - pose.tip).norm(), kTip_mm);
    EXPECT_LT((got.axis - pose.axis).norm(), kAxis);
    double nearest_mm = 1e9, nearest_rad = 1e9;
    for (const double tau : {1.0, -1.0}) {
      JointVector q;
      ASSERT_TRUE(chain::solve(*k, tool, pose.tip, chain::in_frame_a(*k, pose.axis), tau, q));
      double off_mm = 0, off_rad = 0;
      for (std::size_t n = 0; n < joints.size(); ++n) {
        double& off = joints[n].is_rotary ? off_rad : off_mm;
        off = std::max(off, joints[n].is_rotary ? turned(q[n], want[n]) : std::abs(q[n] - want[n]));
      }
      if (off_rad > nearest_rad) continue;
      nearest_rad = off_rad;
      nearest_mm = off_mm;
    }
    EXPECT_LT(nearest_rad, kAngle_rad);
    EXPECT_LT(nearest_mm, kLinear_mm);
  }
}

TEST(FamilyGolden, RobotsAgreeForwardAndInverse) {
  const GoldenTable table(kFolder + "robot_pose.csv");
  ASSERT_EQ(table.size(), 80u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const RobotKinematics k{table.number(row, "joints") == 6, table.number(row, "a_mm"),
                            table.number(row, "b_mm"), table.number(row, "c_mm"),
                            table.number(row, "wrist_mm")};
    const double tool = table.number(row, "tool_mm");
    JointVector want{};
    for (std::size_t n = 0; n < 6; ++n) want[n] = table.number_at(row, 6 + n);
    const ToolPose pose = pose_of(table, row), got = robot::forward(k, tool, want);
    EXPECT_LT((got.tip - pose.tip).norm(), kTip_mm * 10);
    EXPECT_LT((got.axis - pose.axis).norm(), kAxis);
    double nearest = 10;
    for (int branch = 0; branch < robot::kBranchCount; ++branch) {
      JointVector q;
      bool is_held = false;
      ASSERT_TRUE(robot::solve(k, tool, pose, branch, want, q, is_held));
      double off = 0;
      for (std::size_t n = 0; n < 6; ++n) off = std::max(off, turned(q[n], want[n]));
      nearest = std::min(nearest, off);
    }
    EXPECT_LT(nearest, kAngle_rad);
  }
}

TEST(FamilyGolden, StagesAgreeForwardInverseAndInTheirDeterminant) {
  const GoldenTable table(kFolder + "stage_pose.csv");
  ASSERT_EQ(table.size(), 90u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const std::string kind = table.word(row, "kind");
    ActuatorStage stage;
    stage.kind = kind == "pin-slot" ? StageKind::kPinSlot : StageKind::kTwoSlider;
    stage.linear_joint = 0;
    stage.rotary_joint = 1;
    stage.radius_mm = table.number(row, "radius_mm");
    stage.rail_mm = table.number(row, "rail_mm");
    stage.rod_mm = table.number(row, "rod_mm");
    stage.side1 = table.number(row, "side");
    stage.side2 = kind == "trailing" ? stage.side1 : -stage.side1;
    const JointVector want{table.number(row, "s_mm"), table.number(row, "phi_rad")};
    const JointVector u = stage::drives_of(stage, want);
    EXPECT_NEAR(u[0], table.number(row, "u1_mm"), kTip_mm);
    EXPECT_NEAR(u[1], table.number(row, "u2_mm"), kTip_mm);
    const double determinant = table.number(row, "det");
    EXPECT_NEAR(stage::determinant(stage, want), determinant, 1e-10 * std::abs(determinant));
    // Beyond a dead point the drives mean other joints.
    if (determinant < 5) continue;
    const JointVector back = stage::joints_of(stage, u);
    EXPECT_NEAR(back[0], want[0], kLinear_mm);
    EXPECT_NEAR(back[1], want[1], kAngle_rad);
  }
}

}  // namespace
}  // namespace meridian
