// SPDX-License-Identifier: Apache-2.0
// NC programs in place of CL files: from one program of the tool to the next.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "support/command_output.hpp"
#include "support/text_file.hpp"

namespace {

using meridian::test::CommandOutput;
using meridian::test::run_tool;
using meridian::test::TextFile;

const std::string kSource = MERIDIAN_SOURCE_DIR;
const std::string kPart = kSource + "/deploy/parts/blossom.apt";
const std::string kMachine = " -m " + kSource + "/deploy/machines/trunnion-ac.toml ";
const std::string kTools = "--tools " + kSource + "/deploy/tools.toml ";

class NcCommands : public testing::Test {
 protected:
  [[nodiscard]] std::string program() const { return program_.path().string(); }
  [[nodiscard]] std::string recording() const { return recording_.path().string(); }

  void post(const std::string& options) {
    const CommandOutput posted =
        run_tool("post " + kPart + kMachine + kTools + options + "--dialect fanuc -o " + program());
    ASSERT_EQ(posted.exit_code, 0) << posted.output;
  }

  void expect_run() {
    const CommandOutput run = run_tool("simulate " + program() + kMachine + kTools +
                                       "--auxiliary ignore --record " + recording());
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const CommandOutput same =
        run_tool("check " + recording() + " " + program() + kMachine + kTools);
    EXPECT_EQ(same.exit_code, 0) << same.output;
  }

  TextFile program_{"", ".nc"};
  TextFile recording_{"", ".csv"};
};

TEST_F(NcCommands, RunAPostedProgramOfRotaryWords) {
  post("");
  expect_run();
}

TEST_F(NcCommands, RunAPostedProgramOfVectors) {
  post("--vector ");
  expect_run();
}

TEST_F(NcCommands, RunPostedProgramsOfOtherControls) {
  for (const char* const dialect : {"siemens", "heidenhain"}) {
    const CommandOutput posted =
        run_tool("post " + kPart + kMachine + kTools + "--dialect " + dialect + " -o " + program());
    ASSERT_EQ(posted.exit_code, 0) << posted.output;
    expect_run();
  }
}

TEST_F(NcCommands, HoldTheRunAgainstTheCamFileToo) {
  post("--vector ");
  expect_run();
  const CommandOutput check = run_tool("check " + recording() + " " + kPart + kMachine + kTools);
  EXPECT_EQ(check.exit_code, 0) << check.output;
}

TEST_F(NcCommands, SumUpAProgramOfRotaryWordsWithItsMachine) {
  post("");
  const CommandOutput alone = run_tool("cl -s " + program());
  EXPECT_EQ(alone.exit_code, 3);
  EXPECT_NE(alone.output.find("--machine FILE"), std::string::npos) << alone.output;
  const CommandOutput summary = run_tool("cl -s " + program() + kMachine + kTools);
  EXPECT_EQ(summary.exit_code, 0) << summary.output;
  EXPECT_NE(summary.output.find("NC program, Fanuc and ISO words (G43.4)"), std::string::npos)
      << summary.output;
  EXPECT_NE(summary.output.find("work offset    G54"), std::string::npos) << summary.output;
  const CommandOutput json = run_tool("cl --json " + program() + kMachine);
  EXPECT_NE(json.output.find("\"work_offset\": \"G54\""), std::string::npos) << json.output;
}

TEST_F(NcCommands, PutPointsOutInTheFrameAroundThePart) {
  const TextFile nc{"%\nG21 G90\nG43.4 H1\nG0 X1. Y2. Z3. A0. C0.\nM30\n%\n", ".nc"};
  const CommandOutput out =
      run_tool("cl " + nc.path().string() + kMachine + "--frame 100,0,0,0,0,90");
  // Program coordinates lie along the machine's axes, so that the turn of the part cancels out.
  EXPECT_EQ(out.exit_code, 0) << out.output;
  EXPECT_NE(out.output.find("101 2 3 "), std::string::npos) << out.output;
}

TEST_F(NcCommands, GoFromOneWorkOffsetToTheOtherWhereTheirZerosAreGiven) {
  const TextFile nc{"%\nO1\nG21 G90\nG54\nG43 H1\nG0 X1. Y2. Z3.\nG55\nG0 X1. Y2. Z3.\nM30\n%\n",
                    ".nc"};
  const std::string line = "cl " + nc.path().string() + kMachine;
  const CommandOutput without = run_tool(line);
  EXPECT_EQ(without.exit_code, 3);
  EXPECT_NE(without.output.find("--work-zero 2=X,Y,Z"), std::string::npos) << without.output;
  const CommandOutput given = run_tool(line + "--work-zero 1=0,0,0 --work-zero 2=100,0,0");
  EXPECT_EQ(given.exit_code, 0) << given.output;
  EXPECT_NE(given.output.find("101 2 3 "), std::string::npos) << given.output;
  for (const char* wrong : {"2", "2=", "2=1,2", "2=1,2,3,4", "2=1,2,nan", "0=1,2,3", "2=1,2,1e6"}) {
    const CommandOutput out = run_tool(line + "--work-zero " + wrong);
    EXPECT_NE(out.exit_code, 0) << wrong;
    EXPECT_NE(out.output.find("--work-zero"), std::string::npos) << out.output;
  }
}

TEST_F(NcCommands, TakeADialectByName) {
  const std::string plain = "printf 'G21 G90\\nG0 X1. Y2. Z3.\\nG1 X2. F60.\\nM30\\n'";
  EXPECT_EQ(run_tool("cl -", plain).exit_code, 3);
  const CommandOutput out = run_tool("cl --dialect fanuc -", plain);
  EXPECT_EQ(out.exit_code, 0) << out.output;
  EXPECT_NE(out.output.find("2 2 3 0 0 1 60"), std::string::npos) << out.output;
}

TEST_F(NcCommands, WriteAProgramOfOneControlForAnother) {
  post("--vector ");
  const CommandOutput again =
      run_tool("post " + program() + kMachine + kTools + "--dialect siemens");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_NE(again.output.find("TRAORI"), std::string::npos);
}

}  // namespace
