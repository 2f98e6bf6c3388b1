// SPDX-License-Identifier: Apache-2.0
// The shipped reference patch against golden data that are not ours, beside the source tree;
// skipped where absent.
#include <gtest/gtest.h>

#include <filesystem>

#include "golden/golden_table.hpp"
#include "meridian/kinematics/robot.hpp"
#include "service/programs/surface/patch_file.hpp"
#include "support/shared_folder.hpp"

namespace meridian::surface {
namespace {

using test::GoldenTable;

const std::filesystem::path kFolder = test::shared_folder() / "kinematics" / "golden";

constexpr double kPosition_mm = 1e-11;  // reach 1e3 mm, and what rounds in 16 products of the net
constexpr double kUnit = 1e-13, kCurvature_per_mm = 1e-15, kAngle_rad = 1e-12;

Vector3 vector_of(const GoldenTable& table, std::size_t row, const char* column) {
  const std::vector<double> v = table.numbers(row, column, 3);
  return {v[0], v[1], v[2]};
}

class SurfaceCorpus : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder / "N_patch.csv")) {
      GTEST_SKIP() << "no N_patch.csv in the shared folder " << kFolder;
    }
  }
  PatchJob job_ = load_patch(MERIDIAN_SOURCE_DIR "/deploy/parts/reference-patch.toml");
};

TEST_F(SurfaceCorpus, ReferencePatchHasItsPointsNormalsAndCurvatures) {
  const GoldenTable table(kFolder / "N_patch.csv");
  const auto path = cover(job_.rule, job_.cover);
  ASSERT_TRUE(path);
  ASSERT_EQ(table.size(), 441u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const auto line = static_cast<std::size_t>(table.number(row, "iu"));
    const auto contact = static_cast<std::size_t>(table.number(row, "iv"));
    const Contact& c = path->lines[line].contacts[line % 2 == 0 ? contact : 20 - contact];
    EXPECT_LT((c.pose.tip - vector_of(table, row, "Sx")).norm(), kPosition_mm);
    EXPECT_LT((c.pose.axis - vector_of(table, row, "Nx")).norm(), kUnit);
    EXPECT_NEAR(c.shape.min_curvature, table.number(row, "k1"), kCurvature_per_mm);
    EXPECT_NEAR(c.shape.largest_curvature, table.number(row, "k2"), kCurvature_per_mm);
  }
}

TEST_F(SurfaceCorpus, ReferencePathHasTheJointsOfTheRobot) {
  const GoldenTable table(kFolder / "N_patch_robot5.csv");
  const RobotKinematics robot{false, 250, 700, 700, 0};
  constexpr double kTool_mm = 100;
  ASSERT_EQ(table.size(), 441u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const auto c =
        find_contact(job_.rule, table.number(row, "iu") / 20, table.number(row, "iv") / 20);
    ASSERT_TRUE(c);
    const std::vector<double> want = table.numbers(row, "zeta", 5);
    JointVector q, near{};
    bool is_held = false;
    ASSERT_TRUE(robot::solve(robot, kTool_mm, c->pose, 0, near, q, is_held));
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(q[i], want[i], kAngle_rad);
  }
}

TEST_F(SurfaceCorpus, ToroidalCutterTouchesAsItShould) {
  const GoldenTable table(kFolder / "N_torus_cl.csv");
  ASSERT_EQ(table.size(), 60u);
  ContactRule rule = job_.rule;
  rule.runs_along_u = true;
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    rule.cutter = {table.number(row, "D"), table.number(row, "rc")};
    rule.lead_rad = table.number(row, "lead");
    rule.tilt_rad = table.number(row, "tilt");
    const auto c = find_contact(rule, table.number(row, "u"), table.number(row, "v"));
    ASSERT_TRUE(c);
    EXPECT_LT((c->shape.at - vector_of(table, row, "Sx")).norm(), kPosition_mm);
    EXPECT_LT((c->shape.normal - vector_of(table, row, "Nx")).norm(), kUnit);
    EXPECT_LT((c->pose.axis - vector_of(table, row, "Kx")).norm(), kUnit);
    EXPECT_LT((c->pose.tip - vector_of(table, row, "Px")).norm(), kPosition_mm);
  }
}

}  // namespace
}  // namespace meridian::surface
