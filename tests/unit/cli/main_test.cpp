// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

#include "support/private_domain.hpp"

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

TEST(Tool, EverySubcommandExplainsItself) {
  for (const char* name : {"ctl", "status", "drives", "stream"}) {
    EXPECT_EQ(run(std::string(name) + " --help").exit_code, 0) << name;
    EXPECT_EQ(run(std::string(name) + " --no-such-option").exit_code, 2) << name;
  }
}

TEST(Tool, AMissingMachineFileIsRefusedInput) {
  const Outcome outcome = run("drives --machine /no/such/file.toml");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.output.find("/no/such/file.toml"), std::string::npos) << outcome.output;
}

TEST(Tool, AnInjectionThatMakesNoSenseIsAUsageError) {
  const std::string machine = MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml";
  for (const char* what : {"fault", "fault@x", "storm@1", "fault@1:q9"}) {
    EXPECT_EQ(run("drives --machine " + machine + " --inject " + what).exit_code, 2) << what;
  }
}

TEST(Ctl, WithoutAServiceThereIsNoPeer) {
  const meridian::support::PrivateDomain domain;
  const Outcome outcome = run("ctl enable --timeout 0.3 --domain " + std::to_string(domain.id()));
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_NE(outcome.output.find("start meridiand"), std::string::npos) << outcome.output;
}

TEST(Ctl, AnOverrideNeedsItsValueAndOtherVerbsTakeNone) {
  EXPECT_EQ(run("ctl override").exit_code, 2);
  EXPECT_EQ(run("ctl start 50").exit_code, 2);
  EXPECT_EQ(run("ctl dance").exit_code, 2);
  EXPECT_EQ(run("ctl enable --wait Nirvana").exit_code, 2);
}

}  // namespace
