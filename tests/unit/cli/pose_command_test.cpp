// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "support/command_output.hpp"

namespace {

using meridian::test::CommandOutput;
using meridian::test::run_tool;

std::string pose_of(const std::string& machine, const std::string& words) {
  return "pose --machine " MERIDIAN_SOURCE_DIR "/deploy/machines/" + machine + ".toml " + words;
}

/// The joints of a solution as --joints takes them.
std::string joints_of(const nlohmann::json& solution) {
  std::ostringstream out;
  out << std::setprecision(17);
  for (const auto& joint : solution["joints"]) {
    out << (out.tellp() > 0 ? "," : "") << joint["value"].get<double>();
  }
  return out.str();
}

TEST(PoseCommand, JointsOfEveryBranchGiveThePoseBack) {
  for (const char* machine : {"lai", "lai-hybrid", "robot-6r", "nutating-head"}) {
    SCOPED_TRACE(machine);
    const CommandOutput there = run_tool(pose_of(machine, "--json 10 -5 25 0 -0.6 0.8"));
    ASSERT_EQ(there.exit_code, 0) << there.output;
    const auto pose = nlohmann::json::parse(there.output);
    ASSERT_FALSE(pose["solutions"].empty());
    for (const auto& solution : pose["solutions"]) {
      if (!solution["is_inside_travel"].get<bool>()) continue;
      const CommandOutput back =
          run_tool(pose_of(machine, "--json --joints=" + joints_of(solution)));
      ASSERT_EQ(back.exit_code, 0) << back.output;
      const auto joints = nlohmann::json::parse(back.output);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(joints["tip_mm"][i], pose["tip_mm"][i], 1e-6);
        EXPECT_NEAR(joints["axis"][i], pose["axis"][i], 1e-9);
      }
    }
  }
}

TEST(PoseCommand, SaysWhatIsInTheWayOfAPose) {
  const CommandOutput leans = run_tool(pose_of("trunnion-ac", "0 0 50 0 1 -0.9"));
  EXPECT_EQ(leans.exit_code, 1) << leans.output;
  EXPECT_TRUE(leans.output.find("OUTSIDE TRAVEL") != std::string::npos ||
              leans.output.find("out of reach") != std::string::npos)
      << leans.output;
}

TEST(PoseCommand, RefusesWhatIsNoPose) {
  EXPECT_EQ(run_tool(pose_of("lai", "")).exit_code, 2);
  EXPECT_EQ(run_tool(pose_of("lai", "1 2 3")).exit_code, 2);
  EXPECT_EQ(run_tool(pose_of("lai", "1 2 3 0 0 0")).exit_code, 3);
  EXPECT_EQ(run_tool(pose_of("lai", "1 2 3 0 0 nan")).exit_code, 3);
  EXPECT_EQ(run_tool(pose_of("lai", "--joints=1,2")).exit_code, 3);
}

}  // namespace
