// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

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

TEST(Tool, AnOptionThatWouldSayNothingIsAUsageError) {
  EXPECT_EQ(run_tool("ctl enable --for 2").exit_code, 2);
  EXPECT_EQ(run_tool("ctl home --distance 2").exit_code, 2);
  EXPECT_EQ(run_tool("ctl enable --dead-man 100").exit_code, 2);
  EXPECT_EQ(run_tool("ctl enable --wait-time 5").exit_code, 2);
  EXPECT_EQ(run_tool("ctl jog b3 5 --wait Ready").exit_code, 2);
  EXPECT_EQ(run_tool("status --for 2").exit_code, 2);
  EXPECT_EQ(run_tool("stream /no/such --tools /no/such").exit_code, 2);
}

TEST(Tool, VersionIsFine) {
  const CommandOutput outcome = run_tool("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output.rfind("meridian ", 0), 0u) << outcome.output;
}

TEST(Drives, TakeWhatGoesWrongFromStandardInputAndRefuseWhatTheyDoNotKnow) {
  const meridian::support::PrivateDomain domain;
  const std::string machine = "--machine " MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml";
  const CommandOutput outcome = meridian::test::run_command(
      "printf 'spike:b3=2\\nexplode\\nfault@5:b3\\n' | timeout -s INT 2 " MERIDIAN_BINARY_DIR
      "/bin/meridian drives " +
      machine + " --console --domain " + std::to_string(domain.id()) + " 2>&1");
  EXPECT_NE(outcome.output.find("injected: spike:b3=2"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("'explode': KIND is one of"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("'fault@5:b3': here it happens at once"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("drives stopped"), std::string::npos) << outcome.output;
  EXPECT_EQ(run_tool("drives " + machine + " --inject explode@1").exit_code, 2);
}

/// One entry of a help text: what it is about, and what it says about it.
struct HelpEntry {
  std::string name;  ///< `-o,--output`, `stream`
  std::string text;  ///< empty: it explains nothing
};

/// The entries under the heading `section:` of a help text. An explanation begins in column 30, on
/// the same line or, where the name with its type is too long, on the next.
std::vector<HelpEntry> entries_of(const std::string& help, const std::string& section) {
  constexpr std::size_t kColumn = 30;
  std::vector<HelpEntry> entries;
  std::istringstream lines(help);
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] != ' ') {
      is_inside = line == section + ":";
    } else if (is_inside && line.find_first_not_of(' ') == 2) {
      const std::string name = line.substr(2, line.find(' ', 2) - 2);
      const bool has_text = line.size() > kColumn && line[kColumn - 1] == ' ';
      entries.push_back({name, has_text ? line.substr(kColumn) : ""});
    } else if (is_inside && !entries.empty() && line.find_first_not_of(' ') == kColumn) {
      entries.back().text += line.substr(kColumn);
    }
  }
  return entries;
}

/// The subcommands that are built, from the list that registers them.
std::set<std::string> built_commands() {
  std::ifstream list(MERIDIAN_SOURCE_DIR "/service/cli/CMakeLists.txt");
  std::set<std::string> names;
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string word;
    if (std::getline(words >> std::ws, word, '(') && word == "meridian_command" && words >> word) {
      names.insert(word);
    }
  }
  if (!MERIDIAN_HAS_PANEL) names.erase("panel");
  return names;
}

TEST(Tool, EverySubcommandAndEveryOptionOfItExplainsItself) {
  const auto commands = entries_of(run_tool("--help").output, "Subcommands");
  std::set<std::string> names;
  std::size_t options = 0;
  for (const HelpEntry& command : commands) {
    SCOPED_TRACE(command.name);
    names.insert(command.name);
    EXPECT_GT(command.text.size(), 20U) << command.text;
    const CommandOutput help = run_tool(command.name + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(run_tool(command.name + " --no-such-option").exit_code, 2);
    for (const char* section : {"Positionals", "Options"}) {
      for (const HelpEntry& entry : entries_of(help.output, section)) {
        ++options;
        EXPECT_GT(entry.text.size(), 4U) << entry.name << " is not explained";
      }
    }
    EXPECT_NE(help.output.find("Exit codes:"), std::string::npos);
  }
  EXPECT_EQ(names, built_commands());
  EXPECT_GT(options, 100U) << "are the options still found?";
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
