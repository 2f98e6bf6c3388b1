// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "service/process/programs.hpp"
#include "support/command_output.hpp"

namespace meridian::test {
namespace {

namespace fs = std::filesystem;

void write_program(const fs::path& path, const std::string& line) {
  std::ofstream(path) << "#!/bin/sh\n" << line << "\n";
  fs::permissions(path, fs::perms::owner_all);
}

TEST(SoakCommand, StartsDrivesThatEndAtOnceNotAgainBeforeAPause) {
  const process::ScratchFolder beside;
  fs::copy_file(MERIDIAN_BINARY_DIR "/bin/meridian", beside.path() / "soaker");
  write_program(beside.path() / "meridian", "exit 1");
  write_program(beside.path() / "meridiand", "exec sleep 60");
  const CommandOutput soak =
      run_command("MERIDIAN_SHARE=" MERIDIAN_SOURCE_DIR "/deploy " +
                  (beside.path() / "soaker").string() + " soak --for 2s 2>&1");
  EXPECT_EQ(soak.exit_code, 1) << soak.output;
  const std::string ended = "the drives ended by themselves with code 1";
  const std::size_t first = soak.output.find(ended);
  ASSERT_NE(first, std::string::npos) << soak.output;
  EXPECT_EQ(soak.output.find(ended, first + 1), std::string::npos) << soak.output;
}

TEST(SoakCommand, RefusesAReportThatItsOwnTextWouldLieOver) {
  const process::ScratchFolder folder;
  const std::string report = (folder.path() / "soak.txt").string();
  const CommandOutput refused =
      run_command("MERIDIAN_SHARE=" MERIDIAN_SOURCE_DIR "/deploy " MERIDIAN_BINARY_DIR
                  "/bin/meridian soak --for 1s --report " +
                  report + " 2>&1");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("--report: " + report), std::string::npos) << refused.output;
  EXPECT_TRUE(fs::is_empty(folder.path())) << "nothing is written";
}

}  // namespace
}  // namespace meridian::test
