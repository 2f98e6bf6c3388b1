// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "support/command_output.hpp"
#include "support/text_file.hpp"

namespace {

using meridian::test::CommandOutput;
using meridian::test::run_tool;
using meridian::test::TextFile;

const std::string kMachine = " --machine " MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml ";
constexpr const char* kPart =
    "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.6, 0.8\n"
    "GOTO / 90, -40, 20, 0, 0.6, 0.8\nGOTO / 90, -35, 20, 0, 0.6, 0.8\nFINI\n";

class RecordingCommands : public testing::Test {
 protected:
  [[nodiscard]] std::string part() const { return part_.path().string(); }
  [[nodiscard]] std::string recording() const { return recording_.path().string(); }

  TextFile part_{kPart, ".apt"};
  TextFile recording_{"", ".csv"};
};

TEST_F(RecordingCommands, SimulateExplainsWhereTheTimeGoes) {
  const TextFile table{"", ".csv"}, picture{"", ".svg"};
  const CommandOutput outcome =
      run_tool("simulate " + part() + kMachine + "--explain --explain-table " +
               table.path().string() + " --picture " + picture.path().string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("held by"), std::string::npos) << outcome.output;
  EXPECT_NE(meridian::test::read_text(table.path()).find("\n1,4,cut,10.000000,1200.000,"),
            std::string::npos);
  EXPECT_NE(meridian::test::read_text(picture.path()).find("</svg>"), std::string::npos);
  EXPECT_EQ(run_tool("simulate " + part() + kMachine + "--explain-table /no/such/x.csv").exit_code,
            3);
}

TEST_F(RecordingCommands, SimulateCertifiesItsPlan) {
  const CommandOutput outcome =
      run_tool("simulate " + part() + kMachine + "--transition smooth --certify");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("certificate given"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find(", 0 refuted, 0 undecided; "), std::string::npos);
}

TEST_F(RecordingCommands, BeginWithTheToolThatIsInTheSpindle) {
  const std::string tools = "--tools " MERIDIAN_SOURCE_DIR "/deploy/tools.toml ",
                    third = tools + "--tool 3 ";
  const CommandOutput simulated =
      run_tool("simulate " + part() + kMachine + third + "--record " + recording());
  EXPECT_EQ(simulated.exit_code, 0) << simulated.output;
  const std::string check = "check " + recording() + " " + part() + kMachine;
  EXPECT_EQ(run_tool(check + third).exit_code, 0);
  EXPECT_EQ(run_tool(check).exit_code, 1) << "20 mm beside the path of the machine file's tool";
  const CommandOutput unknown = run_tool(check + tools + "--tool 9");
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_NE(unknown.output.find("tools.toml: tool 9 is not there"), std::string::npos)
      << unknown.output;
  EXPECT_EQ(run_tool(check + "--tool 3").exit_code, 2) << "of which table?";
}

TEST_F(RecordingCommands, RecordConvertsToMcap) {
  const TextFile mcap{"", ".mcap"};
  ASSERT_EQ(run_tool("simulate " + part() + kMachine + "--record " + recording()).exit_code, 0);
  const std::string convert = "record --convert " + recording() + kMachine;
  const CommandOutput outcome = run_tool(convert + "--mcap " + mcap.path().string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find(" MB an hour\n"), std::string::npos) << outcome.output;
  EXPECT_EQ(meridian::test::read_text(mcap.path()).substr(0, 5), "\x89MCAP");

  const CommandOutput damaged =
      run_tool("record --convert " + part() + kMachine + "--mcap " + mcap.path().string());
  EXPECT_EQ(damaged.exit_code, 3);
  EXPECT_NE(damaged.output.find(part() + ":1: no recording"), std::string::npos) << damaged.output;
}

TEST_F(RecordingCommands, RecordSaysWhichOptionsBelongTogether) {
  EXPECT_EQ(run_tool("record --convert " + recording() + kMachine).exit_code, 2) << "whereto?";
  EXPECT_EQ(run_tool("record --read a.csv --mcap x.mcap" + kMachine).exit_code, 2);
  EXPECT_EQ(run_tool("record x.csv" + kMachine).exit_code, 2) << "what for?";
  EXPECT_EQ(run_tool("record --convert a.csv --mcap b.mcap").exit_code, 2) << "which machine?";
  EXPECT_EQ(run_tool("record --convert a.csv --mcap b.mcap --read c.csv" + kMachine).exit_code, 2);
  EXPECT_EQ(run_tool("record").exit_code, 2);
  EXPECT_EQ(run_tool("record x.csv --convert a.csv --mcap b.mcap" + kMachine).exit_code, 2);
}

TEST_F(RecordingCommands, SimulateReadsAPipeOnce) {
  const CommandOutput outcome = run_tool("simulate /dev/fd/0" + kMachine, "cat " + part());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("3 of motion"), std::string::npos) << outcome.output;
}

TEST_F(RecordingCommands, TakeALengthForToolsThatNoTableKnows) {
  const TextFile part(
      "UNITS / MM\nLOADTL / 9\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.6, 0.8\n"
      "GOTO / 90, -40, 20, 0, 0.6, 0.8\nLOADTL / 9\nRAPID\nGOTO / 80, -40, 40, 0, 0, 1\nFINI\n",
      ".apt");
  const std::string simulate =
      "simulate " + part.path().string() + kMachine + "--record " + recording() + " ";
  const CommandOutput unknown = run_tool(simulate);
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_NE(unknown.output.find(":2: tool 9 is not in the tool table (2 places, first here); give "
                                "--tools FILE or --unknown-tool-length MM"),
            std::string::npos)
      << unknown.output;
  const CommandOutput known = run_tool(simulate + "--unknown-tool-length 100");
  EXPECT_EQ(known.exit_code, 0) << known.output;
  const std::string check = "check " + recording() + " " + part.path().string() + kMachine;
  EXPECT_EQ(run_tool(check).exit_code, 3);
  EXPECT_EQ(run_tool(check + "--unknown-tool-length 100").exit_code, 0);
}

TEST_F(RecordingCommands, BeginInTheMiddleAtTheLineThatIsNamed) {
  const std::string from = "--from-line 5 ";
  const CommandOutput simulated =
      run_tool("simulate " + part() + kMachine + from + "--record " + recording());
  EXPECT_EQ(simulated.exit_code, 0) << simulated.output;
  const std::string check = "check " + recording() + " " + part() + kMachine;
  EXPECT_EQ(run_tool(check + from).exit_code, 0);
  EXPECT_EQ(run_tool(check).exit_code, 1) << "the begin of the file was not cut";
}

/// The line of the first row in which a joint moves.
std::string line_of_first_motion(const std::string& recording) {
  std::istringstream rows(meridian::test::read_text(recording));
  std::string row, first;
  std::getline(rows, row);  // the names of the columns
  while (std::getline(rows, row)) {
    std::vector<std::string> fields;
    std::istringstream in(row);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    if (fields.size() < 9) continue;
    const std::string joints = fields[4] + fields[5] + fields[6] + fields[7] + fields[8];
    if (first.empty()) first = joints;
    if (joints != first) return fields[2];
  }
  return "none";
}

TEST_F(RecordingCommands, SimulateLeavesThePartBeforeTheSpindleWhereItBeginsInTheMiddle) {
  const TextFile part(
      "UNITS / MM\nSPINDL / RPM, 8000, CLW\nFEDRAT / 1200, MMPM\n"
      "GOTO / 80, -40, 20, 0, 0.6, 0.8\nGOTO / 90, -40, 20, 0, 0.6, 0.8\nFINI\n",
      ".apt");
  const std::string simulate = "simulate " + part.path().string() + kMachine +
                               "--auxiliary ignore --record " + recording() + " ";
  ASSERT_EQ(run_tool(simulate + "--from-line 5").exit_code, 0);
  EXPECT_EQ(line_of_first_motion(recording()), "2") << "in the name of the spindle's block";
  ASSERT_EQ(run_tool(simulate).exit_code, 0);
  EXPECT_EQ(line_of_first_motion(recording()), "4");
}

TEST_F(RecordingCommands, SimulateThenCheckIsFine) {
  const CommandOutput simulated =
      run_tool("simulate " + part() + kMachine + "--transition exact_stop --record " + recording());
  EXPECT_EQ(simulated.exit_code, 0) << simulated.output;
  EXPECT_NE(simulated.output.find("DONE"), std::string::npos) << simulated.output;
  const CommandOutput checked = run_tool("check " + recording() + " " + part() + kMachine +
                                         "--tip-tolerance-mm 0.001 --axis-tolerance-deg 0.001");
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  const CommandOutput same = run_tool("check --same " + recording() + " " + recording() + kMachine);
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_NE(same.output.find("SAME"), std::string::npos) << same.output;
}

TEST_F(RecordingCommands, CheckSaysNoWhereTheMotionIsNotThatOfTheFile) {
  ASSERT_EQ(run_tool("simulate " + part() + kMachine + "--record " + recording()).exit_code, 0);
  const TextFile other(
      "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.6, 0.8\n"
      "GOTO / 90, -40, 20, 0, 0.6, 0.8\nGOTO / 90, -35.002, 20, 0, 0.6, 0.8\nFINI\n",
      ".apt");
  const std::string arguments = "check " + recording() + " " + other.path().string() + kMachine;
  EXPECT_EQ(run_tool(arguments).exit_code, 0) << "inside the machine's tolerance";
  const CommandOutput checked = run_tool(arguments + "--tip-tolerance-mm 0.001 --json");
  EXPECT_EQ(checked.exit_code, 1) << checked.output;
  EXPECT_NE(checked.output.find("\"kind\": \"tip\""), std::string::npos) << checked.output;
  const TextFile nothing("", ".csv");
  const CommandOutput shifted = run_tool("simulate " + part() + kMachine +
                                         "--frame 0,0,1 --record " + nothing.path().string());
  ASSERT_EQ(shifted.exit_code, 0) << shifted.output;
  const CommandOutput same =
      run_tool("check --same " + recording() + " " + nothing.path().string() + kMachine);
  EXPECT_EQ(same.exit_code, 1) << same.output;
  EXPECT_NE(same.output.find("DIFFERENT"), std::string::npos) << same.output;
}

TEST_F(RecordingCommands, ASimulationIsNotWrittenOverWhatItReads) {
  for (const char* written : {"--record ", "--explain-table ", "--picture "}) {
    const CommandOutput refused = run_tool("simulate " + part() + kMachine + written + part());
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.output.find("is read by this run"), std::string::npos) << refused.output;
    EXPECT_EQ(meridian::test::read_text(part_.path()), kPart);
  }
}

TEST_F(RecordingCommands, ASimulationWritesNoFileTwice) {
  const TextFile there("kept\n", ".csv");
  const std::string one = there.path().string();
  const std::string none = one.substr(0, one.size() - 4) + "-new.csv";
  for (const std::string& name : {one, none}) {
    const CommandOutput refused =
        run_tool("simulate " + part() + kMachine + "--record " + name + " --explain-table " + name);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.output.find("is written twice by this run"), std::string::npos)
        << refused.output;
  }
  EXPECT_EQ(meridian::test::read_text(there.path()), "kept\n");
  EXPECT_FALSE(std::filesystem::exists(none));
}

TEST_F(RecordingCommands, MachineFileAndToolTableAreNotWrittenOver) {
  const std::string deploy = MERIDIAN_SOURCE_DIR "/deploy/";
  const std::string machine = meridian::test::read_text(deploy + "machines/lai.toml");
  const std::string tools = meridian::test::read_text(deploy + "tools.toml");
  const TextFile machine_file(machine), tools_file(tools);
  for (const char* command : {"simulate --record ", "post --output "}) {
    for (const TextFile* written : {&machine_file, &tools_file}) {
      const CommandOutput refused =
          run_tool(command + written->path().string() + " " + part() + " --machine " +
                   machine_file.path().string() + " --tools " + tools_file.path().string());
      EXPECT_EQ(refused.exit_code, 3);
      EXPECT_NE(refused.output.find("is read by this run"), std::string::npos) << refused.output;
      EXPECT_EQ(meridian::test::read_text(machine_file.path()), machine) << command;
      EXPECT_EQ(meridian::test::read_text(tools_file.path()), tools) << command;
    }
  }
}

TEST_F(RecordingCommands, ASmoothSimulationNeedsTolerancesThatAreSmoothedBy) {
  std::string machine = meridian::test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  const std::string tip = "tip_mm = 0.01\n";
  machine.replace(machine.find(tip), tip.size(), "tip_mm = 0.0005\n");
  const std::string smooth = "transition = \"smooth\"";
  machine.replace(machine.find(smooth), smooth.size(), "transition = \"exact_stop\"");
  const TextFile file(machine);
  const std::string line = "simulate " + part() + " --machine " + file.path().string();
  EXPECT_EQ(run_tool(line).exit_code, 0);
  const CommandOutput refused = run_tool(line + " --transition smooth");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.output.find("tip tolerance of the machine is 0.0005 mm"), std::string::npos)
      << refused.output;
}

TEST(Commands, DoNotWriteOverTheFileThatTheyWorkOn) {
  const std::string text =
      meridian::test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  const TextFile machine(text, ".toml"), patch("[patch]\n", ".toml");
  const auto refuses = [](const TextFile& file, const std::string& words) {
    const CommandOutput refused = run_tool(words + file.path().string());
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.output.find("is read by this run"), std::string::npos) << refused.output;
  };
  refuses(machine, "machine " + machine.path().string() + " --pattern ");
  EXPECT_EQ(meridian::test::read_text(machine.path()), text);
  refuses(patch, "surface " + patch.path().string() + " -o ");
  EXPECT_EQ(meridian::test::read_text(patch.path()), "[patch]\n");
}

TEST_F(RecordingCommands, CheckSaysWhatIsOddAboutTheFile) {
  ASSERT_EQ(run_tool("simulate " + part() + kMachine + "--record " + recording()).exit_code, 0);
  const TextFile fast("UNITS / MM\nFEDRAT / 1e6, MMPM\nGOTO / 80, -40, 20\nFINI\n", ".apt");
  const CommandOutput checked =
      run_tool("check " + recording() + " " + fast.path().string() + kMachine);
  EXPECT_NE(checked.output.find("warning"), std::string::npos) << checked.output;
}

TEST_F(RecordingCommands, WrongInputIsRefusedByName) {
  EXPECT_EQ(run_tool("check" + kMachine).exit_code, 2);
  EXPECT_EQ(run_tool("simulate " + part()).exit_code, 2) << "no machine";
  const CommandOutput no_file = run_tool("simulate /no/such/part.apt" + kMachine);
  EXPECT_EQ(no_file.exit_code, 3);
  EXPECT_NE(no_file.output.find("/no/such/part.apt"), std::string::npos) << no_file.output;
  const CommandOutput no_recording = run_tool("check " + part() + " " + part() + kMachine);
  EXPECT_EQ(no_recording.exit_code, 3);
  EXPECT_NE(no_recording.output.find("no recording"), std::string::npos) << no_recording.output;
  const CommandOutput feedless =
      run_tool("simulate " + TextFile("GOTO/1,2,3\nFINI\n", ".apt").path().string() + kMachine);
  EXPECT_EQ(feedless.exit_code, 3);
  const TextFile events("5,dance\n", ".csv");
  const CommandOutput bad_events =
      run_tool("simulate " + part() + kMachine + "--events " + events.path().string());
  EXPECT_EQ(bad_events.exit_code, 3);
  EXPECT_NE(bad_events.output.find("'dance' is no verb"), std::string::npos) << bad_events.output;
  EXPECT_EQ(run_tool("simulate " + part() + kMachine + "--record /no/such/folder/r.csv").exit_code,
            3);
}

TEST_F(RecordingCommands, SimulateReplaysEventsAndStartsFromARecording) {
  const TextFile events("100,hold\n1500,resume\n", ".csv");
  const TextFile started("", ".csv");
  const CommandOutput held = run_tool("simulate " + part() + kMachine + "--events " +
                                      events.path().string() + " --record " + recording());
  EXPECT_EQ(held.exit_code, 0) << held.output;
  EXPECT_NE(held.output.find("Approaching -> Holding"), std::string::npos) << held.output;
  const CommandOutput again = run_tool("simulate " + part() + kMachine + "--start-from " +
                                       recording() + " --record " + started.path().string());
  EXPECT_EQ(again.exit_code, 0) << again.output;
}

TEST(RecordCommand, WithoutAServiceThereIsNoPeer) {
  const CommandOutput outcome =
      run_tool("record /tmp/never.csv --machine-name nobody --timeout 0.2 --domain 229");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.output;
}

}  // namespace
