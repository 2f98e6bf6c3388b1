// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/command_output.hpp"
#include "support/document_table.hpp"
#include "support/text_file.hpp"

namespace {

using meridian::test::CommandOutput;
using meridian::test::run_tool;
using meridian::test::TextFile;

const std::string kTrunnion = MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml";
const std::string kBlossom = MERIDIAN_SOURCE_DIR
    "/deploy/parts/blossom.apt --tools " MERIDIAN_SOURCE_DIR "/deploy/tools.toml";

/// The number behind `words`.
double number_after(const std::string& words, const std::string& text) {
  const std::size_t at = text.find(words);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? -1 : std::stod(text.substr(at + words.size()));
}

TEST(PlacingCommand, FastestPrintsTheTimesThatBothFramesWereSimulatedWith) {
  const CommandOutput found = run_tool("machine " + kTrunnion + " --place " + kBlossom +
                                       " --fastest --box 100,300,100,300,50,150");
  ASSERT_EQ(found.exit_code, 0) << found.output;
  const double quick_s = number_after("time ", found.output);
  const double widest_s = number_after("largest margin ", found.output);
  EXPECT_GT(quick_s, 1);
  EXPECT_LE(quick_s, widest_s);
  const std::size_t at = found.output.find("--frame ");
  ASSERT_NE(at, std::string::npos) << found.output;
  const std::string frame = found.output.substr(at + 8, found.output.find('\n', at) - at - 8);
  const CommandOutput run =
      run_tool("simulate " + kBlossom + " --machine " + kTrunnion + " --frame=" + frame);
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NEAR(number_after("time ", run.output), quick_s, 0.06) << run.output;
}

TEST(PlacingCommand, FastestWantsAFileThatCanBeReadTwice) {
  const CommandOutput pipe = run_tool("machine " + kTrunnion + " --place - --fastest </dev/null");
  EXPECT_NE(pipe.exit_code, 0);
  EXPECT_NE(pipe.output.find("give a file"), std::string::npos) << pipe.output;
}

TEST(PlacingCommand, NamesEverythingThatIsInTheWayAsThePageShows) {
  const TextFile part(
      "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\nGOTO/1500,0,0,0,0,1\n"
      "GOTO/1500,1500,0,0,0,1\nGOTO/0,1500,0,0,0,1\nFINI\n",
      ".apt");
  const TextFile machine(
      meridian::test::read_text(kTrunnion) + "\n[[keep_out]]\nname = \"vice\"\nX_mm = [100, 690]\n",
      ".toml");
  const CommandOutput none =
      run_tool("machine " + machine.path().string() + " --place " + part.path().string());
  EXPECT_EQ(none.exit_code, 1) << none.output;
  meridian::test::expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/machine-files.md", "nowhere",
                                           "```\n" + none.output + "```\n");
}

}  // namespace
