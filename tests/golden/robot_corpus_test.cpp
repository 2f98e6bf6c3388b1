// SPDX-License-Identifier: Apache-2.0
// Every branch of the robots, the planar robot of Sarraji as a special case of them, and the Lai
// machine with its stage, against golden data that are not ours; skipped where absent.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "golden/golden_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "support/shared_folder.hpp"

namespace meridian {
namespace {

using test::GoldenTable;

const std::filesystem::path kFolder = test::shared_folder() / "kinematics" / "golden";

constexpr double kTip_mm = 1e-9, kAxis = 1e-13, kAngle_rad = 1e-12, kLinear_mm = 1e-10;
constexpr double kTool_mm = 100;

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

ToolPose pose_of(const GoldenTable& table, std::size_t row) {
  const Vector3 axis(table.number(row, "Kx"), table.number(row, "Ky"), table.number(row, "Kz"));
  return {{table.number(row, "Px"), table.number(row, "Py"), table.number(row, "Pz")},
          axis.normalized()};
}

class RobotBranches : public testing::TestWithParam<const char*> {};

TEST_P(RobotBranches, AllEightAreThoseOfTheCorpus) {
  const std::string name = GetParam();
  const std::filesystem::path file = kFolder / ("C_" + name + "_branches.csv");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared folder: " << file;
  const bool is_six = name == "robot6";
  const RobotKinematics k{is_six, 250, 700, 700, 0};
  const GoldenTable table(file);
  ASSERT_EQ(table.size(), 160u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const int branch = (table.number(row, "back") < 0 ? 1 : 0) |
                       (table.number(row, "elbow_branch") < 0 ? 2 : 0) |
                       (table.number(row, "flip") < 0 ? 4 : 0);
    const ToolPose pose = pose_of(table, row);
    JointVector q;
    bool is_held = false;
    ASSERT_TRUE(robot::solve(k, kTool_mm, pose, branch, JointVector{}, q, is_held));
    const ToolPose back = robot::forward(k, kTool_mm, q);
    EXPECT_LT((back.tip - pose.tip).norm(), kTip_mm);
    EXPECT_LT((back.axis - pose.axis).norm(), kAxis);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_LT(turned(q[i], table.number_at(row, 10 + i)), kAngle_rad) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, RobotBranches, testing::Values("robot5", "robot6"));

TEST(RobotCorpusPlanar, TheRobotOfSarrajiIsTheOneWithFiveJointsAndNoTilt) {
  const std::filesystem::path file = kFolder / "C_planar4.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared folder: " << file;
  const RobotKinematics k{false, 250, 700, 700, 0};
  const GoldenTable table(file);
  ASSERT_EQ(table.size(), 110u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const JointVector want{table.number(row, "zeta"),
                           table.number(row, "shoulder"),
                           table.number(row, "elbow"),
                           table.number(row, "wrist"),
                           0,
                           0};
    const ToolPose pose = pose_of(table, row), got = robot::forward(k, kTool_mm, want);
    EXPECT_LT((got.tip - pose.tip).norm(), kTip_mm);
    EXPECT_LT((got.axis - pose.axis).norm(), kAxis);
    const Vector3 wrist(table.number(row, "Wx"), table.number(row, "Wy"), table.number(row, "Wz"));
    EXPECT_LT((got.tip + kTool_mm * got.axis - wrist).norm(), kTip_mm);
    double nearest = 10;
    for (int branch = 0; branch < robot::kBranchCount; ++branch) {
      JointVector q;
      bool is_held = false;
      if (!robot::solve(k, kTool_mm, pose, branch, want, q, is_held)) continue;
      double apart = 0;
      for (std::size_t i = 0; i < 5; ++i) apart = std::max(apart, turned(q[i], want[i]));
      nearest = std::min(nearest, apart);
    }
    EXPECT_LT(nearest, kAngle_rad);
  }
}

TEST(StageCorpusMachine, TheLaiMachineOnATrailingStageGivesItsSliders) {
  const std::filesystem::path file = kFolder / "S_machineA.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared folder: " << file;
  MachineModel model;
  model.lai =
      lai_from_table({.b1 = 120, .a2 = 450, .a3 = 35, .l3 = 80, .l4 = 60, .b5 = 25, .l5 = 140});
  model.stage = test::trailing_stage(1.5);
  const GoldenTable table(file);
  ASSERT_EQ(table.size(), 100u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    JointVector want{};
    for (std::size_t i = 0; i < 5; ++i) want[i] = table.number_at(row, 6 + i);
    const ToolPose pose = pose_of(table, row);
    const auto at = solve(model, 110, pose, want[4] < 0 ? 1 : 0, want);
    ASSERT_EQ(at.status, SolveStatus::kOk);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(at.q[i], want[i], i < 3 ? kLinear_mm : kAngle_rad) << i;
    }
    const LimitedVector all = limited_of(model, at.q);
    EXPECT_NEAR(all[5], table.number(row, "u1"), kLinear_mm);
    EXPECT_NEAR(all[6], table.number(row, "u2"), kLinear_mm);
    const JointVector back = joints_of(model, drives_of(model, at.q));
    EXPECT_NEAR(back[1], want[1], kLinear_mm);
    EXPECT_NEAR(back[3], want[3], kAngle_rad);
  }
}

}  // namespace
}  // namespace meridian
