// SPDX-License-Identifier: Apache-2.0
// Golden data: lai_*.csv in this folder, written by generate_lai.py from the corrected table.
#include <gtest/gtest.h>

#include "golden/lai_machine.hpp"
#include "meridian/kinematics/jacobian.hpp"

namespace meridian {
namespace {

using namespace test;

GoldenTable load(const char* name) {
  return GoldenTable(std::filesystem::path(MERIDIAN_SOURCE_DIR "/tests/golden") / name);
}

TEST(LaiGolden, ForwardEqualsTheProductOfTheCorrectedTable) {
  const GoldenTable table = load("lai_pose.csv");
  ASSERT_GT(table.size(), 100u);
  double tip_error = 0, axis_error = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const GoldenMachine machine(table, row, "_mm");
    const ToolPose want = pose_of(table.numbers(row, "x_mm", 6));
    const ToolPose got =
        forward(machine.model, machine.tool_length_mm, joints_of(table.numbers(row, "b3_mm", 5)));
    tip_error = std::max(tip_error, (got.tip - want.tip).cwiseAbs().maxCoeff());
    axis_error = std::max(axis_error, (got.axis - want.axis).cwiseAbs().maxCoeff());
  }
  std::printf("tip %.2g mm, axis %.2g\n", tip_error, axis_error);
  EXPECT_LT(tip_error, kTipTolerance_mm);
  EXPECT_LT(axis_error, kAxisTolerance);
}

TEST(LaiGolden, InverseGivesTheJointsOnBothBranches) {
  const GoldenTable table = load("lai_pose.csv");
  int near = 0, random = 0, pole = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE("row " + std::to_string(row));
    const GoldenMachine machine(table, row, "_mm");
    const ToolPose pose = pose_of(table.numbers(row, "x_mm", 6));
    const bool is_random = table.word(row, "kind") == "random";
    std::vector<JointVector> wanted = {joints_of(table.numbers(row, "b3_mm", 5))};
    if (is_random) wanted.push_back(joints_of(table.numbers(row, "alt_b3_mm", 5)));
    for (const JointVector& want : wanted) {
      const auto s = solve(machine.model, machine.tool_length_mm, pose, branch_of(want), want);
      for (int j = 0; j < 5; ++j) {
        EXPECT_NEAR(s.q[j], want[j], j < 3 ? kLinearTolerance_mm : kAngleTolerance_rad) << j;
      }
      pole += s.status == SolveStatus::kAtPole;
    }
    near += table.word(row, "kind") == "near";
    random += is_random;
  }
  EXPECT_GE(random, 90);
  EXPECT_GE(near, 40);
  EXPECT_GE(pole, 8);
}

TEST(LaiGolden, SmallTiltsKeepTheirRelativeAccuracy) {
  const GoldenTable table = load("lai_pose.csv");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const JointVector want = joints_of(table.numbers(row, "b3_mm", 5));
    if (want[4] == 0) continue;
    const GoldenMachine machine(table, row, "_mm");
    const auto s = solve(machine.model, machine.tool_length_mm,
                         pose_of(table.numbers(row, "x_mm", 6)), branch_of(want), want);
    EXPECT_NEAR(s.q[4] / want[4], 1, 1e-14) << "row " << row;
  }
}

TEST(LaiGolden, JacobianAndMeasureEqualTheDerivativesOfTheProduct) {
  const GoldenTable table = load("lai_jacobian.csv");
  ASSERT_GE(table.size(), 20u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    const GoldenMachine machine(table, row, "_mm");
    const JointVector q = joints_of(table.numbers(row, "b3_mm", 5));
    const Jacobian got = jacobian(machine.model, machine.tool_length_mm, q);
    const std::vector<double> want = table.numbers(row, "j00", 30);
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 5; ++c) {
        EXPECT_NEAR(got(r, c), want[5 * r + c], r < 3 ? kTipTolerance_mm : kAxisTolerance)
            << "row " << row << " entry " << r << "," << c;
      }
    }
    EXPECT_NEAR(measure(machine.model, q), table.number(row, "measure"), kAxisTolerance);
  }
}

TEST(LaiGolden, JetsAlongAPathEqualItsDerivatives) {
  const GoldenTable table = load("lai_path.csv");
  ASSERT_GE(table.size(), 20u);
  const char* const kColumns[] = {"b3_mm", "d1_b3_mm", "d2_b3_mm", "d3_b3_mm"};
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE("row " + std::to_string(row));
    const GoldenMachine machine(table, row, "_mm");
    const ToolPose begin = pose_of(table.numbers(row, "x_mm", 6));
    const std::vector<double> slope = table.numbers(row, "vx", 3);
    const std::vector<double> side = table.numbers(row, "ni", 3);
    const Jet<3> s = Jet<3>::variable(0.0);
    const auto [sine, cosine] = sin_cos(table.number(row, "turn_rad_per_mm") * s);
    Pose<Jet<3>> pose;
    for (int k = 0; k < 3; ++k) {
      pose.tip[k] = begin.tip[k] + slope[k] * s;
      pose.axis[k] = cosine * begin.axis[k] + sine * side[k];
    }
    const JointVector reference = joints_of(table.numbers(row, "b3_mm", 5));
    const auto solved = solve(machine.model, machine.tool_length_mm, pose,
                              static_cast<int>(table.number(row, "branch")), reference);
    for (int order = 0; order <= 3; ++order) {
      const std::vector<double> want = table.numbers(row, kColumns[order], 5);
      for (int j = 0; j < 5; ++j) {
        // The axis of the path is unit to 1e-16 only; derivatives are of order 1 per mm and below.
        const double tolerance =
            order == 0 ? (j < 3 ? kLinearTolerance_mm : kAngleTolerance_rad) : 1e-12;
        EXPECT_NEAR(solved.q[j].derivative(order), want[j], tolerance)
            << "joint " << j << " order " << order;
      }
    }
  }
}

}  // namespace
}  // namespace meridian
