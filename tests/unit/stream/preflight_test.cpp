// SPDX-License-Identifier: Apache-2.0
#include "service/stream/preflight.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "support/machines.hpp"

namespace meridian::stream {
namespace {

/// A CL file that goes with the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(testing::TempDir() + "meridian-preflight-" + std::to_string(::getpid()) + ".apt") {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

const char* const kHead = "PARTNO/TEST\nUNITS/MM\nFEDRAT/600,MMPM\n";

PreflightReport judged(const std::string& body, bool has_machine = true) {
  const TemporaryFile file(kHead + body);
  std::optional<PreflightMachine> machine;
  if (has_machine) machine = PreflightMachine{test::lai_machine(), ToolTable({{3, 100, 5}})};
  return preflight(file.path(), {}, machine);
}

TEST(Preflight, PassesAGoodFileAndTellsItsTime) {
  const PreflightReport report =
      judged("GOTO/0,0,0,0,0,1\nGOTO/30,0,0,0,0,1\nGOTO/30,20,0,0,0,1\nFINI\n");
  EXPECT_EQ(report.refusal, "");
  EXPECT_EQ(report.blocks, 4u);  // the end counts
  EXPECT_NEAR(report.times.total_s(), 5, 1e-9);
  EXPECT_FALSE(report.contains_actions);
}

TEST(Preflight, RefusesABlockOutOfTravelByFileLineAndJoint) {
  const PreflightReport report = judged("GOTO/0,0,0,0,0,1\nGOTO/0,0,5000,0,0,1\nFINI\n");
  EXPECT_NE(report.refusal.find(".apt: line 5, block 1: b4 at "), std::string::npos)
      << report.refusal;
}

TEST(Preflight, RefusesAToolThatTheMachineDoesNotHave) {
  EXPECT_EQ(judged("LOADTL/3\nGOTO/0,0,0,0,0,1\nFINI\n").refusal, "");
  EXPECT_NE(judged("LOADTL/4\nGOTO/0,0,0,0,0,1\nFINI\n").refusal.find("tool 4"), std::string::npos);
}

TEST(Preflight, SeesActionWords) {
  EXPECT_TRUE(judged("SPINDL/RPM,8000,CLW\nGOTO/0,0,0,0,0,1\nFINI\n").contains_actions);
}

TEST(Preflight, WithoutAMachineOnlyTheReaderJudges) {
  EXPECT_EQ(judged("GOTO/0,0,5000,0,0,1\nFINI\n", false).refusal, "");
  EXPECT_NE(judged("GOTO/0,0,nan,0,0,1\nFINI\n", false).refusal, "");
}

TEST(Preflight, RefusesAFileThatIsNotThere) {
  EXPECT_EQ(preflight("/no/such/file.apt", {}, std::nullopt).refusal,
            "/no/such/file.apt: cannot be opened; check the path and the right to read it");
}

}  // namespace
}  // namespace meridian::stream
