// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "support/command_output.hpp"
#include "support/private_domain.hpp"

namespace {

using meridian::test::CommandOutput;
using meridian::test::run_tool;

TEST(Tool, HelpIsFineAndNamesTheExitCodes) {
  const CommandOutput outcome = run_tool("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("4 the machine refused"), std::string::npos) << outcome.output;
}

TEST(Tool, NoSubcommandIsAUsageError) { EXPECT_EQ(run_tool("").exit_code, 2); }

TEST(Tool, UnknownSubcommandIsAUsageError) { EXPECT_EQ(run_tool("dance").exit_code, 2); }

TEST(Tool, VersionIsFine) {
  const CommandOutput outcome = run_tool("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output.rfind("meridian ", 0), 0u) << outcome.output;
}

TEST(Tool, EverySubcommandExplainsItself) {
  for (const char* name : {"ctl", "status", "drives", "stream"}) {
    EXPECT_EQ(run_tool(std::string(name) + " --help").exit_code, 0) << name;
    EXPECT_EQ(run_tool(std::string(name) + " --no-such-option").exit_code, 2) << name;
  }
}

TEST(Tool, AMissingMachineFileIsRefusedInput) {
  const CommandOutput outcome = run_tool("drives --machine /no/such/file.toml");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.output.find("/no/such/file.toml"), std::string::npos) << outcome.output;
}

TEST(Tool, AnInjectionThatMakesNoSenseIsAUsageError) {
  const std::string machine = MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml";
  for (const char* what : {"fault", "fault@x", "storm@1", "fault@1:q9"}) {
    EXPECT_EQ(run_tool("drives --machine " + machine + " --inject " + what).exit_code, 2) << what;
  }
}

TEST(Ctl, WithoutAServiceThereIsNoPeer) {
  const meridian::support::PrivateDomain domain;
  const CommandOutput outcome =
      run_tool("ctl enable --timeout 0.3 --domain " + std::to_string(domain.id()));
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_NE(outcome.output.find("start meridiand"), std::string::npos) << outcome.output;
}

TEST(Ctl, AnOverrideNeedsItsValueAndOtherVerbsTakeNone) {
  EXPECT_EQ(run_tool("ctl override").exit_code, 2);
  EXPECT_EQ(run_tool("ctl start 50").exit_code, 2);
  EXPECT_EQ(run_tool("ctl dance").exit_code, 2);
  EXPECT_EQ(run_tool("ctl enable --wait Nirvana").exit_code, 2);
}

}  // namespace
