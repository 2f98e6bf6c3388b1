// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/pose_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "service/machine/file/machine_file.hpp"

namespace meridian::inspect {
namespace {

MachineModel machine_of_table(const std::string& name) {
  return config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/" + name + ".toml");
}

std::vector<TableRow> read(const std::string& text, const std::vector<std::string>& columns) {
  std::istringstream in(text);
  const auto rows = read_table(in, "t.csv", columns);
  EXPECT_TRUE(rows) << rows.error();
  return rows ? *rows : std::vector<TableRow>();
}

std::string error_of(const std::string& text) {
  std::istringstream in(text);
  const auto rows = read_table(in, "t.csv", pose_columns());
  return rows ? "" : rows.error();
}

TEST(PoseTable, TakesColumnsByPlaceOrByName) {
  const auto plain =
      read("# poses\n1, 2;3\t0 0 1 # first\r\n\n+1.5 0 0 0 0.6 0.8\n", pose_columns());
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain[0].values, (std::vector<double>{1, 2, 3, 0, 0, 1}));
  EXPECT_EQ(plain[1].line, 4U);
  const auto named = read("n,k,j,i,z_mm,y_mm,x_mm\nA1,1,0,0,3,2,1\n", pose_columns());
  ASSERT_EQ(named.size(), 1U);
  EXPECT_EQ(named[0].values, (std::vector<double>{1, 2, 3, 0, 0, 1}));
}

TEST(PoseTable, NamesEveryLineThatItCannotRead) {
  EXPECT_EQ(error_of("1 2 3 0 0 1\n1 2 3\n1 2 3 0 x 1\n1 2 3 0 0 inf\n"),
            "t.csv:2: 3 values, 6 are needed: x_mm, y_mm, z_mm, i, j, k\n"
            "t.csv:3: 'x' is no finite number\nt.csv:4: 'inf' is no finite number\n");
  EXPECT_NE(error_of("x_mm,y_mm\n1,2\n").find("t.csv:1: no column z_mm"), std::string::npos);
  EXPECT_EQ(error_of("# nothing\n"), "t.csv: no row of numbers\n");
}

TEST(PoseTable, ComesBackFromItsJoints) {
  for (const char* const name : {"trunnion-ac", "lai-hybrid", "robot-6r"}) {
    SCOPED_TRACE(name);
    const MachineModel model = machine_of_table(name);
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) q[i] = model.joints[i].home + 0.02 * (i + 1);
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    const TableRow wanted{
        1, {pose.tip[0], pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2]}};
    const TableResult solutions = solve_table(model, {wanted});
    EXPECT_EQ(solutions.unreached, 0U) << solutions.text;
    const auto joints = read(solutions.text, joint_columns(model));
    ASSERT_GE(joints.size(), 1U);
    const auto back = read(pose_table(model, joints).text, pose_columns());
    ASSERT_EQ(back.size(), joints.size());
    for (const TableRow& row : back) {
      for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(row.values[k], wanted.values[k], 1e-5);
    }
  }
}

TEST(PoseTable, CountsWhatNothingReaches) {
  const MachineModel model = machine_of_table("trunnion-ac");
  const TableResult result = solve_table(model, {{3, {0, 0, 1e5, 0, 0, 1}}});
  EXPECT_EQ(result.unreached, 1U);
  const TableResult json = solve_table_json(model, {{3, {0, 0, 1e5, 0, 0, 1}}});
  EXPECT_NE(json.text.find("\"line\": 3"), std::string::npos) << json.text;
}

}  // namespace
}  // namespace meridian::inspect
