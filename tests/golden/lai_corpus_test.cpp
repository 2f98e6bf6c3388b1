// SPDX-License-Identifier: Apache-2.0
// Cross-check against golden data that are not ours, beside the source tree; skipped where absent.
#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "golden/lai_machine.hpp"
#include "meridian/kinematics/jacobian.hpp"
#include "support/shared_folder.hpp"

namespace meridian {
namespace {

using namespace test;

const std::filesystem::path kFolder = test::shared_folder() / "kinematics" / "golden";

/// The machine of A_fkik.csv and A_jacobian.csv; their constants stand in a comment line.
GoldenMachine machine_of_the_folder() {
  return {{.b1 = 120, .a2 = 450, .a3 = 35, .l3 = 80, .l4 = 60, .b5 = 25, .l5 = 140}, 110};
}

void expect_pose(const ToolPose& got, const ToolPose& want) {
  EXPECT_LT((got.tip - want.tip).cwiseAbs().maxCoeff(), kTipTolerance_mm);
  EXPECT_LT((got.axis - want.axis).cwiseAbs().maxCoeff(), kAxisTolerance);
}

class LaiCorpus : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder / "A_fkik.csv")) {
      GTEST_SKIP() << "no A_fkik.csv in " << kFolder;
    }
  }
};

/// `want` lead to `pose`, and on their branch back.
void expect_both_directions(const GoldenMachine& machine, const ToolPose& pose,
                            const JointVector& want) {
  expect_pose(forward(machine.model, machine.tool_length_mm, want), pose);
  const auto s = solve(machine.model, machine.tool_length_mm, pose, branch_of(want), want);
  for (int j = 0; j < 5; ++j) {
    EXPECT_NEAR(s.q[j], want[j], j < 3 ? kLinearTolerance_mm : kAngleTolerance_rad) << j;
  }
}

TEST_F(LaiCorpus, ForwardAndInverseAgreeWithA_fkik) {
  const GoldenTable table(kFolder / "A_fkik.csv");
  ASSERT_EQ(table.size(), 304u);
  const GoldenMachine machine = machine_of_the_folder();
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE("row " + std::to_string(row) + " " + table.word(row, "kind"));
    const ToolPose pose = pose_of(table.numbers(row, "Px", 6));
    for (const char* first : {"b3", "b3_alt"}) {
      const JointVector want = joints_of(table.numbers(row, first, 5));
      expect_both_directions(machine, pose, want);
    }
  }
}

TEST_F(LaiCorpus, EveryConstantHasTheSignOfA_params) {
  const GoldenTable table(kFolder / "A_params.csv");
  ASSERT_EQ(table.size(), 60u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE("row " + std::to_string(row));
    const GoldenMachine machine(table, row, "");
    const JointVector want = joints_of(table.numbers(row, "b3", 5));
    const ToolPose pose = pose_of(table.numbers(row, "Px", 6));
    expect_both_directions(machine, pose, want);
  }
}

TEST_F(LaiCorpus, JacobianAgreesWithA_jacobian) {
  const GoldenTable table(kFolder / "A_jacobian.csv");
  ASSERT_EQ(table.size(), 40u);
  const GoldenMachine machine = machine_of_the_folder();
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE("row " + std::to_string(row));
    const JointVector q = joints_of(table.numbers(row, "b3", 5));
    const Jacobian got = jacobian(machine.model, machine.tool_length_mm, q);
    const std::vector<double> want = table.numbers(row, "J11", 30);
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 5; ++c) {
        EXPECT_NEAR(got(r, c), want[5 * r + c], r < 3 ? kTipTolerance_mm : kAxisTolerance);
      }
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd{Eigen::MatrixXd(got)};
    const std::vector<double> singular = table.numbers(row, "s1", 5);
    for (int k = 0; k < 5; ++k) {  // absolute accuracy of an SVD: eps times the largest, 500
      EXPECT_NEAR(svd.singularValues()[k], singular[k], 1e-11) << k;
    }
    double product = 1;
    for (const double s : singular) product *= s;
    EXPECT_NEAR(measure(machine.model, q) / product, 1, 1e-12);
  }
}

}  // namespace
}  // namespace meridian
