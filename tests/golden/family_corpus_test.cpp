// SPDX-License-Identifier: Apache-2.0
// The five-axis family, the robots and the stages against golden data that are not ours, beside the
// source tree; skipped where absent.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "golden/golden_table.hpp"
#include "meridian/kinematics/chain.hpp"
#include "meridian/kinematics/robot.hpp"
#include "meridian/kinematics/stage.hpp"
#include "support/shared_folder.hpp"

namespace meridian {
namespace {

using test::GoldenTable;

const std::filesystem::path kFolder = test::shared_folder() / "kinematics" / "golden";

constexpr double kTip_mm = 1e-10, kAxis = 1e-14, kAngle_rad = 1e-12;

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

/// "1/3", "-2.5" or "sqrt(1/2)" as the data write them.
double number_of(const std::string& text) {
  if (const auto root = text.find("sqrt("); root != std::string::npos) {
    const double sign = text[0] == '-' ? -1.0 : 1.0;
    return sign * std::sqrt(number_of(text.substr(root + 5, text.rfind(')') - root - 5)));
  }
  const auto slash = text.find('/');
  if (slash == std::string::npos) return std::stod(text);
  return std::stod(text.substr(0, slash)) / std::stod(text.substr(slash + 1));
}

Vector3 vector_of(const nlohmann::json& list) {
  return {number_of(list[0]), number_of(list[1]), number_of(list[2])};
}

struct GoldenChain {
  ChainKinematics chain;
  double tool_length_mm = 0;
  Vector3 workpiece_mm = Vector3::Zero();
};

GoldenChain chain_of(const std::string& name) {
  std::ifstream file(kFolder / "machines.json");
  const auto machine = nlohmann::json::parse(file)["machines"][name];
  std::array<ChainJoint, ChainKinematics::kChainLength> joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& joint = machine["chain"][i];
    joints[i].joint = static_cast<int>(i);
    joints[i].is_rotary = joint["type"] == "R";
    joints[i].is_table_side = joint["side"] == "table";
    joints[i].direction = vector_of(joint["dir"]);
    if (joints[i].is_rotary) joints[i].point_mm = vector_of(joint["point"]);
  }
  return {*describe_chain(joints, vector_of(machine["k0"]), vector_of(machine["gauge"])),
          number_of(machine["tool_length"]), vector_of(machine["workpiece_zero"])};
}

class FamilyCorpus : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder / "machines.json")) {
      GTEST_SKIP() << "no machines.json in the shared folder " << kFolder;
    }
  }
};

/// The numbers of a data row from its first joint on.
struct ChainRow {
  JointVector q{};
  Vector3 tip, axis;
  double tau;
};

ChainRow row_of(const GoldenTable& table, std::size_t row, const ChainKinematics& k) {
  const std::size_t first = table.is_number(row, 0) ? 0 : 1;
  const auto at = [&](std::size_t i) { return table.number_at(row, first + i); };
  ChainRow out;
  out.q[k.a.joint] = at(0);
  out.q[k.b.joint] = at(1);
  for (std::size_t i = 0; i < 3; ++i) out.q[k.linear[i].joint] = at(2 + i);
  out.tip = {at(5), at(6), at(7)};
  out.axis = {at(8), at(9), at(10)};
  out.tau = at(11);
  return out;
}

TEST_P(FamilyCorpus, ChainAgreesForwardAndInverse) {
  const GoldenChain machine = chain_of(GetParam());
  const ChainKinematics& k = machine.chain;
  const GoldenTable table(kFolder / ("B_" + std::string(GetParam()) + ".csv"));
  ASSERT_EQ(table.size(), 64u);
  const bool is_skew = std::string(GetParam()) == "HT_SKEW";
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const ChainRow want = row_of(table, row, k);
    const ToolPose pose = chain::forward(k, machine.tool_length_mm, want.q);
    EXPECT_LT((pose.tip - machine.workpiece_mm - want.tip).norm(), 1e-9);
    EXPECT_LT((pose.axis - want.axis).norm(), kAxis);
    JointVector q;
    const ToolPose there{want.tip + machine.workpiece_mm, want.axis.normalized()};
    ASSERT_TRUE(chain::solve(k, machine.tool_length_mm, there.tip, chain::in_frame_a(k, there.axis),
                             want.tau, q));
    const double angle = is_skew ? 1e-12 : kAngle_rad, linear = is_skew ? 1e-8 : kTip_mm;
    EXPECT_LT(turned(q[k.a.joint], want.q[k.a.joint]), angle);
    EXPECT_LT(turned(q[k.b.joint], want.q[k.b.joint]), angle);
    for (const auto& joint : k.linear) EXPECT_NEAR(q[joint.joint], want.q[joint.joint], linear);
    EXPECT_NEAR(chain::measure(k, want.q), table.number(row, "measure"), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, FamilyCorpus,
                         testing::Values("HH_AB", "HH_BA", "HH_CA", "HH_CB", "HT_AC", "HT_BA",
                                         "HT_BC", "HT_SKEW", "NH_BC", "NH_CA", "NT_BC", "TT_AB",
                                         "TT_AC", "TT_BC"));

TEST(FamilyCorpusReach, IsExactlyTheInterval) {
  if (!std::filesystem::exists(kFolder / "B_reach.csv")) GTEST_SKIP() << "no shared folder";
  const GoldenTable table(kFolder / "B_reach.csv");
  ASSERT_EQ(table.size(), 112u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const GoldenChain machine = chain_of(table.word(row, "machine"));
    const Vector3 axis(table.number(row, "Kx"), table.number(row, "Ky"), table.number(row, "Kz"));
    const auto half =
        chain::half_angle<double>(chain::in_frame_a(machine.chain, Vector3(axis.normalized())));
    EXPECT_EQ(chain::triangle(half, chain::cone_of(machine.chain)).is_reachable,
              table.number(row, "n") > 0);
    const auto reach = chain::reach(machine.chain);
    EXPECT_NEAR(reach.min_rad, table.number(row, "lo"), 1e-14);
    EXPECT_NEAR(reach.largest_rad, table.number(row, "hi"), 1e-14);
  }
}

class RobotCorpus : public testing::TestWithParam<const char*> {};

TEST_P(RobotCorpus, AgreesForwardAndInverseOnTheBranch) {
  const std::filesystem::path file = kFolder / ("C_" + std::string(GetParam()) + ".csv");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared folder: " << file;
  const bool is_six = std::string(GetParam()) == "robot6";
  const RobotKinematics k{is_six, 250, 700, 700, 0};
  constexpr double kTool_mm = 100;
  const GoldenTable table(file);
  ASSERT_EQ(table.size(), 140u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    JointVector want{};
    for (std::size_t i = 0; i < 5; ++i) want[i] = table.number_at(row, 1 + i);
    const Vector3 tip(table.number(row, "Px"), table.number(row, "Py"), table.number(row, "Pz"));
    const Vector3 axis(table.number(row, "Kx"), table.number(row, "Ky"), table.number(row, "Kz"));
    const ToolPose pose = robot::forward(k, kTool_mm, want);
    EXPECT_LT((pose.tip - tip).norm(), 1e-9);
    EXPECT_LT((pose.axis - axis).norm(), kAxis);
    const int branch = (table.number(row, "back") < 0 ? 1 : 0) |
                       (table.number(row, "elbow_branch") < 0 ? 2 : 0) |
                       (table.number(row, "flip") < 0 ? 4 : 0);
    JointVector q;
    bool is_held = false;
    ASSERT_TRUE(
        robot::solve(k, kTool_mm, ToolPose{tip, axis.normalized()}, branch, want, q, is_held));
    const ToolPose back = robot::forward(k, kTool_mm, q);
    EXPECT_LT((back.tip - tip).norm(), 1e-9);
    EXPECT_LT((back.axis - axis.normalized()).norm(), 1e-12);
    const double measure = table.number(row, "measure");
    EXPECT_NEAR(robot::measure(k, want), measure, 1e-9 * measure + 1e-4);
    if (table.word(row, "kind") != "random") continue;
    for (std::size_t i = 0; i < 5; ++i) EXPECT_LT(turned(q[i], want[i]), kAngle_rad) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, RobotCorpus, testing::Values("robot5", "robot6"));

class StageCorpus : public testing::TestWithParam<const char*> {};

TEST_P(StageCorpus, AgreesForwardAndInverse) {
  const std::filesystem::path file = kFolder / ("S_" + std::string(GetParam()) + ".csv");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared folder: " << file;
  const bool is_trailing = std::string(GetParam()) == "trailing";
  ActuatorStage stage;
  stage.kind = StageKind::kTwoSlider;
  stage.linear_joint = 0;
  stage.rotary_joint = 1;
  stage.radius_mm = 150;
  stage.rail_mm = is_trailing ? 150 : 0;
  stage.rod_mm = 300;
  stage.side2 = is_trailing ? 1 : -1;
  stage.phi_max_rad = 1.05;
  const GoldenTable table(file);
  ASSERT_EQ(table.size(), 120u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const JointVector q{table.number(row, "s"), table.number(row, "phi")};
    const JointVector u = stage::drives_of(stage, q);
    EXPECT_NEAR(u[0], table.number(row, "u1"), 1e-10);
    EXPECT_NEAR(u[1], table.number(row, "u2"), 1e-10);
    const JointVector back = stage::joints_of(stage, u);
    EXPECT_NEAR(back[0], q[0], 1e-10);
    EXPECT_NEAR(back[1], q[1], 1e-12);
    EXPECT_NEAR(stage::determinant(stage, q),
                table.number(row, "du2_dphi") - table.number(row, "du1_dphi"), 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, StageCorpus, testing::Values("trailing", "scissor"));

}  // namespace
}  // namespace meridian
