// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace {

struct Outcome {
  int exit_code;
  std::string output;
};

/// Runs the tool with `arguments`, standard output and standard error together.
Outcome run(const std::string& arguments) {
  const std::string command =
      std::string(MERIDIAN_BINARY_DIR) + "/bin/meridian " + arguments + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {-1, {}};
  std::string output;
  char buffer[4096];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, n);
  return {WEXITSTATUS(pclose(pipe)), output};
}

TEST(Tool, HelpIsFineAndNamesTheExitCodes) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("4 the machine refused"), std::string::npos) << outcome.output;
}

TEST(Tool, NoSubcommandIsAUsageError) { EXPECT_EQ(run("").exit_code, 2); }

TEST(Tool, UnknownSubcommandIsAUsageError) { EXPECT_EQ(run("dance").exit_code, 2); }

TEST(Tool, VersionIsFine) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output.rfind("meridian ", 0), 0u) << outcome.output;
}

}  // namespace
