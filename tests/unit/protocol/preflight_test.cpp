// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/preflight.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/machines.hpp"
#include "support/text_file.hpp"

namespace meridian::stream {
namespace {

const char* const kHead = "PARTNO/TEST\nUNITS/MM\nFEDRAT/600,MMPM\n";

std::string text_of(const PreflightReport& report) { return to_text(report.findings, "part.apt"); }

PreflightReport checked(const std::string& body, bool has_machine = true) {
  const test::TextFile file(kHead + body, ".apt");
  std::optional<PreflightMachine> machine;
  if (has_machine) machine = PreflightMachine{test::lai_machine(), ToolTable({{3, 100, 5}})};
  return preflight(file.path(), {}, machine);
}

TEST(Preflight, PassesAGoodFileAndReportsItsTime) {
  const PreflightReport report =
      checked("GOTO/0,0,0,0,0,1\nGOTO/30,0,0,0,0,1\nGOTO/30,20,0,0,0,1\nFINI\n");
  EXPECT_FALSE(report.is_refused) << text_of(report);
  EXPECT_EQ(report.blocks, 4u);  // the end counts
  EXPECT_NEAR(report.times.total_s(), 5, 1e-9);
  EXPECT_FALSE(report.contains_actions);
}

TEST(Preflight, RefusesABlockOutOfTravelByFileLineAndJoint) {
  const PreflightReport report = checked("GOTO/0,0,0,0,0,1\nGOTO/0,0,5000,0,0,1\nFINI\n");
  EXPECT_TRUE(report.is_refused);
  EXPECT_EQ(text_of(report).find("part.apt:5: b4 at "), 0U) << text_of(report);
}

TEST(Preflight, RefusesAToolThatTheMachineDoesNotHave) {
  EXPECT_FALSE(checked("LOADTL/3\nGOTO/0,0,0,0,0,1\nFINI\n").is_refused);
  const PreflightReport report = checked("LOADTL/4\nGOTO/0,0,0,0,0,1\nFINI\n");
  EXPECT_TRUE(report.is_refused);
  EXPECT_NE(text_of(report).find(":4: tool 4 is not in the tool table; add it"), std::string::npos)
      << text_of(report);
}

TEST(Preflight, FindsAllThatIsInTheWayOfAFileInOnePass) {
  const PreflightReport report = checked(
      "LOADTL/4\nGOTO/0,0,5000,0,0,1\n"  // 4: unknown; its reach is not checked
      "LOADTL/3\nGOTO/0,0,6000,0,0,1\nGOTO/0,0,7000,0,0,1\n"  // 7, 8: out of travel
      "LOADTL/4\nWOBBLE/1\nGOTO/0,0,0,0,0,1\nFINI\n");        // 9: as 4; 10: unknown word
  EXPECT_TRUE(report.is_refused);
  ASSERT_EQ(report.findings.size(), 3U) << text_of(report);
  EXPECT_EQ(report.findings[0].line, 4U);
  EXPECT_EQ(report.findings[0].count, 2U);
  EXPECT_EQ(report.findings[1].line, 7U);
  EXPECT_EQ(report.findings[1].count, 2U);
  EXPECT_EQ(report.findings[2].line, 10U);
}

TEST(Preflight, DoesNotCheckAnArcWhoseBeginWasRefused) {
  const PreflightReport report =
      checked("GOTO/0,0,5000,0,0,1\nCIRCLE/10,0,5000,0,0,1\nGOTO/20,0,5000\nGOTO/0,0,0\nFINI\n");
  ASSERT_EQ(report.findings.size(), 1U) << text_of(report);
  EXPECT_EQ(report.findings[0].count, 1U);
}

TEST(Preflight, NamesTheToolsThatTheTableHasNot) {
  const test::TextFile file("UNITS/MM\nLOADTL/9\nLOADTL/3\nFOO/1\nLOADTL/4\nLOADTL/9\nFINI\n",
                            ".apt");
  EXPECT_EQ(unknown_tools(file.path(), {}, ToolTable({{3, 100, 5}})), (std::vector<int>{9, 4}));
}

TEST(Preflight, SeesActionWords) {
  EXPECT_TRUE(checked("SPINDL/RPM,8000,CLW\nGOTO/0,0,0,0,0,1\nFINI\n").contains_actions);
}

TEST(Preflight, WithoutAMachineOnlyTheReaderChecks) {
  EXPECT_FALSE(checked("GOTO/0,0,5000,0,0,1\nFINI\n", false).is_refused);
  EXPECT_TRUE(checked("GOTO/0,0,nan,0,0,1\nFINI\n", false).is_refused);
}

TEST(Preflight, RefusesAFileThatIsNotThere) {
  const PreflightReport report = preflight("/no/such/file.apt", {}, std::nullopt);
  EXPECT_TRUE(report.is_refused);
  EXPECT_EQ(to_text(report.findings, "/no/such/file.apt"),
            "/no/such/file.apt: cannot be opened; check the path and the right to read it\n");
}

}  // namespace
}  // namespace meridian::stream
