// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/command_output.hpp"
#include "support/scratch.hpp"
#include "support/text_file.hpp"

namespace {

using meridian::test::CommandOutput;
using meridian::test::run_tool;
using meridian::test::TextFile;

std::string text_of(const TextFile& file) {
  std::ifstream in(file.path());
  return {std::istreambuf_iterator<char>(in), {}};
}

const std::string kPart = MERIDIAN_SOURCE_DIR "/deploy/parts/blossom.apt";

TEST(ClCommand, GivesOnePointALineForEveryMotionBlock) {
  const CommandOutput outcome = run_tool("cl " + kPart);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 148);
  EXPECT_EQ(outcome.output.substr(0, outcome.output.find('\n')).substr(0, 5), "79.8 ");
}

TEST(ClCommand, PutsPointsOutInTheFrameAroundTheWorkpiece) {
  const CommandOutput outcome =
      run_tool("cl --frame 100,0,0,0,0,90 -", "printf 'UNITS/MM\\nFEDRAT/60\\nGOTO/1,2,3\\n'");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("98 1 3 0 0 1 60"), std::string::npos) << outcome.output;
}

TEST(ClCommand, PrintsASummary) {
  const CommandOutput outcome = run_tool("cl --summary " + kPart);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("MERIDIAN BLOSSOM"), std::string::npos);
}

TEST(ClCommand, RefusesWithExitCodeThree) {
  EXPECT_EQ(run_tool("cl /no/such/file").exit_code, 3);
  const CommandOutput outcome = run_tool("cl -", "printf 'UNITS/MM\\nGOTO/1,2,3\\n'");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.output.find("--feed MM_PER_MIN"), std::string::npos);
  EXPECT_EQ(run_tool("cl --units mm -", "printf 'FEDRAT/60\\nGOTO/1,2,3\\n'").exit_code, 0);
  EXPECT_EQ(run_tool("cl --units mm --feed 60 -", "printf 'GOTO/1,2,3'").exit_code, 0);
}

TEST(ClCommand, ReadsAFileWithoutAUnitInMillimetreAndSaysSo) {
  const CommandOutput outcome = run_tool("cl -s -", "printf 'FEDRAT/60\\nGOTO/1,2,3\\n'");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("warning: NO UNIT WORD"), std::string::npos) << outcome.output;
}

TEST(ClCommand, ReadsAFileWithoutAUnitInThatOfItsFeedsAndRefusesItFromAPipe) {
  const std::string part = "RAPID\nGOTO/0,0,1\nFEDRAT/10,IPM\nGOTO/1,0,0\nFINI\n";
  const TextFile file(part, ".cls");
  const CommandOutput read = run_tool("cl -s --json " + file.path().string());
  EXPECT_EQ(read.exit_code, 0) << read.output;
  EXPECT_NE(read.output.find("\"unit\": \"inch\""), std::string::npos) << read.output;
  EXPECT_NE(read.output.find("\"unit_source\": \"feed\""), std::string::npos) << read.output;
  EXPECT_NE(read.output.find("as its feeds are (line 3)"), std::string::npos) << read.output;
  const CommandOutput piped = run_tool("cl -", "cat " + file.path().string());
  EXPECT_EQ(piped.exit_code, 3) << piped.output;
  EXPECT_NE(piped.output.find("a file, unlike a pipe"), std::string::npos) << piped.output;
  EXPECT_EQ(run_tool("cl --units inch -", "cat " + file.path().string()).exit_code, 0);
}

TEST(SimulateCommand, GivesWordsToolsAndTravelTogetherAsJson) {
  const std::string machine = std::string(" --json -m ") + MERIDIAN_SOURCE_DIR
                              "/deploy/machines/trunnion-ac.toml --tools " MERIDIAN_SOURCE_DIR
                              "/deploy/tools.toml";
  const TextFile wrong(
      "UNITS/MM\nFEDRAT/600\nLOADTL/77\nFOO/1\nRETRCT\nLOADTL/1\nGOTO/9000,0,0\nFINI\n", ".apt");
  const CommandOutput refused = run_tool("simulate " + wrong.path().string() + machine);
  EXPECT_EQ(refused.exit_code, 3) << refused.output;
  for (const char* part :
       {"\"is_refused\": true",
        "\"line\": 3, \"severity\": \"refusal\", \"count\": 1, \"message\": "
        "\"tool 77 is not in the tool table\"",
        "unknown word 'FOO'", "RETRCT retracts", "\"line\": 7", "leaves travel"}) {
    EXPECT_NE(refused.output.find(part), std::string::npos) << part << "\n" << refused.output;
  }
  const CommandOutput fine = run_tool("simulate " + kPart + machine);
  EXPECT_EQ(fine.exit_code, 0) << fine.output;
  EXPECT_NE(fine.output.find("\"is_refused\": false"), std::string::npos) << fine.output;
  EXPECT_EQ(fine.output.find("DONE"), std::string::npos) << "it is not run";
  EXPECT_EQ(run_tool("simulate -" + machine, "printf 'UNITS/MM\\n'").exit_code, 3) << "a pipe";
}

TEST(ClCommand, GivesEverythingThatIsWrongWithAFileAtOnceAsTextAndAsJson) {
  const std::string program =
      "printf 'UNITS/MM\\nFOO/1\\nGOTO/1,2,3\\nFEDRAT/-1\\nFOO/2\\nGOTO/1,2\\nFINI\\n'";
  const CommandOutput text = run_tool("cl -", program);
  EXPECT_EQ(text.exit_code, 3);
  for (const char* part : {":2: unknown word", "(2 places, first here)", ":3: cutting motion",
                           ":4: feed", ":6: GOTO needs"}) {
    EXPECT_NE(text.output.find(part), std::string::npos) << part << "\n" << text.output;
  }
  const CommandOutput json = run_tool("cl --json -", program);
  EXPECT_EQ(json.exit_code, 3);
  EXPECT_NE(json.output.find("\"is_refused\": true"), std::string::npos) << json.output;
  EXPECT_NE(json.output.find("\"line\": 6, \"severity\": \"refusal\""), std::string::npos);
  EXPECT_NE(json.output.find("\"dialect\": \"APT\""), std::string::npos);
}

TEST(ClCommand, PrintsTheTableOfWords) {
  const CommandOutput words = run_tool("cl --words");
  EXPECT_EQ(words.exit_code, 0);
  EXPECT_NE(words.output.find("GOTO/x,y,z[,i,j,k]"), std::string::npos) << words.output;
  EXPECT_NE(words.output.find("PROBE/..."), std::string::npos) << words.output;
}

TEST(ClCommand, PassesEachWordThatIsAllowed) {
  const std::string program = "printf 'UNITS/MM\\nFEDRAT/60\\nFOO/1\\nBAR\\nGOTO/1,2,3\\nFINI\\n'";
  EXPECT_EQ(run_tool("cl -", program).exit_code, 3);
  EXPECT_EQ(run_tool("cl --allow-unknown FOO -", program).exit_code, 3);
  EXPECT_EQ(run_tool("cl --allow-unknown FOO --allow-unknown BAR -", program).exit_code, 0);
}

TEST(ClCommand, LeavesWhatIsThereWhereItRefuses) {
  const std::string program = "UNITS/MM\nFEDRAT/60\nGOTO/1,2,3\nFINI\n";
  const TextFile part(program, ".apt"), kept("kept\n", ".txt");
  const std::string name = part.path().string();
  const CommandOutput itself = run_tool("cl " + name + " -o " + name);
  EXPECT_EQ(itself.exit_code, 3);
  EXPECT_NE(itself.output.find("is read by this run"), std::string::npos) << itself.output;
  EXPECT_EQ(text_of(part), program);
  const TextFile bad("UNITS/MM\nFEDRAT/60\nGOTO/1,2,3\nGOTO/1,2,three\n", ".apt");
  EXPECT_EQ(run_tool("cl " + bad.path().string() + " -o " + kept.path().string()).exit_code, 3);
  EXPECT_EQ(text_of(kept), "kept\n");
  EXPECT_EQ(run_tool("cl " + name + " -o " + kept.path().string()).exit_code, 0);
  EXPECT_EQ(text_of(kept), "1 2 3 0 0 1 60\n");
  EXPECT_EQ(run_tool("cl " + name + " -o /dev/full").exit_code, 3);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(ClCommand, TakesNoNumberThatIsNone) {
  const std::string machine = " --machine " MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml ";
  const std::string lines[] = {"cl /no/such --feed=", "cl /no/such --chord-error=",
                               "check /no/such" + machine + "--tip-tolerance-mm=",
                               "simulate /no/such" + machine + "--override-ramp-s="};
  for (const std::string& line : lines) {
    EXPECT_EQ(run_tool(line + "1").exit_code, 3) << line;  // the file, not the number
    for (const char* number : {"nan", "-nan", "inf", "0", "-1", "x"}) {
      EXPECT_EQ(run_tool(line + number).exit_code, 2) << line << number;
    }
  }
  EXPECT_EQ(run_tool("ctl override nan").exit_code, 2);
}

TEST(ClCommand, TakesNoToleranceBelowWhatIsPlannedFor) {
  const std::string machine = " --machine " MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml ";
  struct Line {
    const char *option, *min, *below;
  };
  constexpr Line kLines[] = {{"--tip-tolerance-mm", "0.001", "0.00099"},
                             {"--axis-tolerance-deg", "0.00573", "0.0057"}};
  for (const std::string command : {"simulate", "stream"}) {
    for (const Line& line : kLines) {
      const std::string begin = command + " /no/such" + machine + line.option + " ";
      const CommandOutput refused = run_tool(begin + line.below);
      EXPECT_EQ(refused.exit_code, 2) << refused.output;
      for (const char* part : {line.option, line.below, line.min}) {
        EXPECT_NE(refused.output.find(part), std::string::npos) << part << ": " << refused.output;
      }
    }
  }
  EXPECT_EQ(run_tool("simulate /no/such" + machine + "--tip-tolerance-mm 0.001").exit_code, 3);
}

TEST(ClCommand, KnowsUsage) {
  EXPECT_EQ(run_tool("cl").exit_code, 2);
  EXPECT_EQ(run_tool("cl --units furlong " + kPart).exit_code, 2);
  EXPECT_EQ(run_tool("cl --help").exit_code, 0);
}

TEST(SurfaceCommand, WritesASampleByItsName) {
  const meridian::test::Scratch file(".apt");
  EXPECT_EQ(run_tool("surface --sample blossom -o " + file.path()).exit_code, 0);
  EXPECT_TRUE(std::ifstream(file.path()).good());
  EXPECT_EQ(run_tool("surface --sample nothing").exit_code, 2);
  EXPECT_EQ(run_tool("surface --sample blossom -o /no/such/place/x").exit_code, 3);
  EXPECT_EQ(run_tool("surface --help").exit_code, 0);
}

const std::string kPatch = MERIDIAN_SOURCE_DIR "/deploy/parts/reference-patch.toml";

TEST(SurfaceCommand, CoversAPatchAndReportsBesideIt) {
  const meridian::test::Scratch file(".apt");
  const CommandOutput to_file = run_tool("surface " + kPatch + " -o " + file.path());
  EXPECT_EQ(to_file.exit_code, 0);
  EXPECT_NE(to_file.output.find("21 lines, 441 contacts"), std::string::npos) << to_file.output;
  EXPECT_EQ(run_tool("cl " + file.path()).exit_code, 0);
  const meridian::test::Scratch picture(".svg");
  EXPECT_EQ(run_tool("surface " + kPatch + " -o /dev/null --picture " + picture.path()).exit_code,
            0);
  EXPECT_NE(meridian::test::read_text(picture.path()).find("</svg>"), std::string::npos);
  const meridian::test::Scratch wrists(".csv");
  EXPECT_EQ(run_tool("surface " + kPatch + " -o /dev/null --wrist-distance 80 --wrist-points " +
                     wrists.path() + " --picture " + picture.path())
                .exit_code,
            0);
  EXPECT_NE(meridian::test::read_text(picture.path()).find("wrist, S + dN"), std::string::npos);
  EXPECT_NE(meridian::test::read_text(wrists.path()).find("x_mm,y_mm,z_mm,i,j,k\n"),
            std::string::npos);
  EXPECT_EQ(run_tool("surface " + kPatch + " --wrist-points " + wrists.path()).exit_code, 2);
  const CommandOutput finer =
      run_tool("surface " + kPatch + " --points 5 --lines 3 -o " + file.path());
  EXPECT_NE(finer.output.find("3 lines, 15 contacts"), std::string::npos) << finer.output;
  EXPECT_EQ(run_tool("surface " + kPatch + " 2>/dev/null | head -1").output,
            "PARTNO REFERENCE PATCH\n");
}

TEST(SurfaceCommand, SaysNoToACutterThatGougesAndToWhatItCannotTake) {
  std::string text = meridian::test::read_text(kPatch);
  text.replace(text.find("diameter_mm = 10"), 16, "diameter_mm = 560");
  const meridian::test::TextFile large(text);
  const CommandOutput outcome = run_tool("surface " + large.path().string() + " -o /dev/null");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("WARNING"), std::string::npos);
  EXPECT_EQ(run_tool("surface " + kPatch + " -o /no/such/place/x").exit_code, 3);
  EXPECT_EQ(run_tool("surface /no/such/patch.toml").exit_code, 3);
  EXPECT_EQ(run_tool("surface").exit_code, 2);
  EXPECT_EQ(run_tool("surface " + kPatch + " --sample blossom").exit_code, 2);
  EXPECT_EQ(run_tool("surface " + kPatch + " --points 5 --chord-error-mm 1").exit_code, 2);
  EXPECT_EQ(run_tool("surface " + kPatch + " -o /dev/null --picture /tmp/x.bmp").exit_code, 3);
}

const std::string kMachine = MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml";

TEST(MachineCommand, ReportsDrawsAndWritesAPattern) {
  const meridian::test::Scratch picture(".svg");
  const meridian::test::Scratch pattern(".apt");
  const CommandOutput outcome = run_tool("machine " + kMachine + " --picture " + picture.path() +
                                         " --pattern " + pattern.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("workpiece - C - A - X - Y - Z - tool"), std::string::npos);
  EXPECT_NE(meridian::test::read_text(picture.path()).find("</svg>"), std::string::npos);
  EXPECT_EQ(run_tool("cl " + pattern.path()).exit_code, 0);
}

TEST(MachineCommand, SaysNoToASlipAndToWhatItCannotTake) {
  EXPECT_EQ(run_tool("machine " + kMachine + " --frame 0,9000,0").exit_code, 1);
  EXPECT_EQ(run_tool("machine /no/such/machine.toml").exit_code, 3);
  EXPECT_EQ(run_tool("machine " + kMachine + " --picture x.bmp").exit_code, 3);
  EXPECT_EQ(run_tool("machine " + kMachine + " --pattern /no/such/place/x").exit_code, 3);
  EXPECT_EQ(run_tool("machine").exit_code, 2);
}

}  // namespace
