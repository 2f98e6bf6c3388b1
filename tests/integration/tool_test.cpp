// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "integration/plant.hpp"

namespace meridian::test {
namespace {

constexpr milliseconds kShort{10'000}, kLong{40'000};

const char* const kGoodPart =
    "PARTNO/GOOD\nUNITS/MM\nFEDRAT/6000,MMPM\nGOTO/0,0,150,0,0,1\n"
    "GOTO/20,0,150,0.1736481777,0,0.9848077530\nGOTO/20,20,150,0,0,1\nFINI\n";
const char* const kPartOutOfTravel =
    "PARTNO/FAR\nUNITS/MM\nFEDRAT/6000,MMPM\nGOTO/0,0,150,0,0,1\nGOTO/2000,0,150,0,0,1\nFINI\n";

/// The tool against a service, as a person or a script uses it.
class Tool : public testing::Test {
 protected:
  Process run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "meridian");
    arguments.insert(arguments.end(), {"--domain", plant.domain()});
    const auto log = plant.folder() / ("tool-" + std::to_string(++runs_) + ".log");
    return Process(arguments, log);
  }
  std::string part(const std::string& name, const std::string& text) {
    const auto path = plant.folder() / name;
    std::ofstream(path) << text;
    return path.string();
  }

  Plant plant;

 private:
  int runs_ = 0;
};

TEST_F(Tool, StreamsAPartFromOpenToEnd) {
  plant.start_service();
  plant.start_drives();
  Process enable = run({"ctl", "enable", "--wait", "Ready"});
  ASSERT_EQ(enable.wait(kShort), 0) << enable.said();
  Process stream = run({"stream", part("good.apt", kGoodPart), "--wait-end", "--station", "cam-1"});
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << stream.said();
  Process second = run({"stream", part("other.apt", kGoodPart), "--station", "cam-2"});
  EXPECT_EQ(second.wait(kShort), 4) << second.said();
  EXPECT_NE(second.said().find("is held by station cam-1 with program good.apt"), std::string::npos)
      << second.said();
  Process start = run({"ctl", "start", "--wait", "Ready"});
  EXPECT_EQ(start.wait(kLong), 0) << start.said() << plant.service().said();
  EXPECT_EQ(stream.wait(kShort), 0) << stream.said();
  const std::string said = stream.said();
  EXPECT_NE(said.find("program good.apt is in: 4 blocks"), std::string::npos) << said;
  EXPECT_NE(said.find("machine is Running"), std::string::npos) << said;
  EXPECT_NE(said.find("approach to line 4: "), std::string::npos) << said;
  EXPECT_NE(said.find("program good.apt ran to its end: 3 blocks in "), std::string::npos) << said;
  EXPECT_EQ(said.find('\r'), std::string::npos) << "in a pipe plain lines";
}

TEST_F(Tool, SaysWhatIsForADryRunAloneToADryRunAlone) {
  plant.start_service();
  plant.start_drives();
  (void)plant.status();
  std::optional<dds::Reply> reply;
  ASSERT_TRUE(eventually([&] {
    reply = plant.say(Verb::kEnable, 1);
    return reply && reply->refusal != Refusal::kStale;
  }));
  EXPECT_EQ(reply->refusal, Refusal::kNotDryRun) << reply->text;
  Process wet = run({"ctl", "enable", "--dry-run"});
  EXPECT_EQ(wet.wait(kShort), 4) << wet.said();
  EXPECT_NE(wet.said().find("refused: enable refused: it is for a dry run alone"),
            std::string::npos)
      << wet.said();
  EXPECT_EQ(plant.status().state, State::kOff);
  Process misplaced = run({"ctl", "resume", "--dry-run"});
  EXPECT_EQ(misplaced.wait(kShort), 2) << misplaced.said();
  Process probe =
      run({"ctl", "probe", "--toward=+x", "--distance", "5", "--feed", "60", "--dry-run"});
  EXPECT_EQ(probe.wait(kShort), 2) << "drives would move: " << probe.said();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kDryRun, 1));
  Process dry = run({"ctl", "enable", "--dry-run", "--wait", "Ready"});
  EXPECT_EQ(dry.wait(kShort), 0) << dry.said();
  EXPECT_NE(dry.said().find("accepted: dry run: "), std::string::npos) << dry.said();
}

/// One drawing of the progress bar.
struct Bar {
  int full = 0, percent = 0;
  int block = 0, block_count = 0, line = 0;
  int feed_mm_per_min = -1;  ///< -1: a rapid
  int to_go_s = -1;          ///< -1: not said
};

/// The bars in what a terminal was shown, of a program at `feed` mm/min.
std::vector<Bar> bars_in(const std::string& shown, const std::string& feed) {
  const std::regex pattern(
      "\r\x1b\\[K\\[(#*)(\\.*)\\] +(\\d+) % block (\\d+) of (\\d+), line (\\d+), "
      "(?:feed (\\d+) of " +
      feed + "|rapid at \\d+) mm/min(?:, to go (\\d+):(\\d\\d))?");
  std::vector<Bar> bars;
  for (std::sregex_iterator i(shown.begin(), shown.end(), pattern), end; i != end; ++i) {
    const auto number = [&i](std::size_t n) { return std::stoi(i->str(n)); };
    EXPECT_EQ(i->length(1) + i->length(2), 24);
    Bar bar{static_cast<int>(i->length(1)), number(3), number(4), number(5), number(6)};
    if (i->length(7) > 0) bar.feed_mm_per_min = number(7);
    if (i->length(8) > 0) bar.to_go_s = 60 * number(8) + number(9);
    bars.push_back(bar);
  }
  return bars;
}

TEST_F(Tool, ShowsABarWithBlockFeedAndTimeToGoOnATerminal) {
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  const std::string text =
      "PARTNO/BAR\nUNITS/MM\nFEDRAT/1500,MMPM\n" + cl_text(small_program(16, 1500, 5)) + "FINI\n";
  Terminal terminal;
  Process stream(
      {"meridian", "stream", part("bar.apt", text), "--wait-end", "--domain", plant.domain()},
      plant.folder() / "bar.log", nullptr, &terminal);
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << terminal.shown() << stream.said();
  Process start = run({"ctl", "start"});
  ASSERT_EQ(start.wait(kShort), 0) << start.said();
  ASSERT_TRUE(eventually(
      [&] {
        (void)terminal.shown();  // nobody else empties the terminal
        return stream.wait(milliseconds(0)).has_value();
      },
      kLong))
      << terminal.shown();
  EXPECT_EQ(stream.wait(kShort), 0) << terminal.shown();
  const std::string shown = terminal.shown();
  EXPECT_NE(shown.find("\r\x1b[Kmachine is Running"), std::string::npos)
      << "a message wipes the bar: " << shown;
  const std::vector<Bar> bars = bars_in(shown, "1500");
  ASSERT_GE(bars.size(), 10U) << shown;
  Bar before = bars.front();
  int fastest = -1, longest_s = -1, shortest_s = 9999;
  for (const Bar& bar : bars) {
    EXPECT_EQ(bar.block_count, 17) << "sixteen points and the end";
    EXPECT_LE(bar.block, bar.block_count);
    EXPECT_TRUE(bar.line == 0 || (bar.line > 3 && bar.line < 21)) << bar.line;
    EXPECT_GE(bar.block, before.block);
    EXPECT_GE(bar.percent, before.percent);
    EXPECT_NEAR(bar.full, bar.percent * 24 / 100.0, 1);
    EXPECT_LE(bar.feed_mm_per_min, 1500);
    fastest = std::max(fastest, bar.feed_mm_per_min);
    if (bar.to_go_s >= 0) {
      longest_s = std::max(longest_s, bar.to_go_s);
      shortest_s = std::min(shortest_s, bar.to_go_s);
    }
    before = bar;
  }
  EXPECT_GT(bars.back().block, bars.front().block);
  EXPECT_GT(fastest, 1400) << "the feed that is cut, not that of the file";
  EXPECT_GE(longest_s, 4) << "112 mm at 25 mm/s";
  EXPECT_LE(shortest_s, 1) << shown;
}

TEST_F(Tool, StreamsAPipeAtThePaceOfItsWriter) {
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  InputPipe pipe;
  Process stream({"meridian", "stream", "-", "--wait-end", "--domain", plant.domain()},
                 plant.folder() / "pipe.log", &pipe);
  const auto program = small_program(12, 600);
  const std::vector<ClBlock> first(program.begin(), program.begin() + 9);
  pipe.write("PARTNO/PIPE\nUNITS/MM\nFEDRAT/600,MMPM\n" + cl_text(first));
  ASSERT_TRUE(eventually([&] { return plant.status().blocks_received >= first.size(); }, kShort))
      << "a batch that is not full waits for nobody: " << stream.said();
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << stream.said();
  EXPECT_EQ(stream.said().find('%'), std::string::npos)
      << "nothing is under way: " << stream.said();
  Process start = run({"ctl", "start", "--wait", "Starved"});
  ASSERT_EQ(start.wait(kLong), 0) << start.said() << plant.service().said();
  EXPECT_NE(stream.said().find('%'), std::string::npos) << stream.said();
  pipe.write(cl_text(program, first.size()) + "FINI\n");
  pipe.close();
  Process resume = run({"ctl", "resume"});
  EXPECT_TRUE(resume.wait(kShort));  // refused where the machine went on by itself
  EXPECT_EQ(stream.wait(kLong), 0) << stream.said() << plant.service().said();
  EXPECT_NE(stream.said().find("ran to its end"), std::string::npos) << stream.said();
}

TEST_F(Tool, LeavesAPipeThatIsSilentWhenItIsInterrupted) {
  plant.start_service();
  InputPipe pipe;
  Process stream({"meridian", "stream", "-", "--domain", plant.domain()},
                 plant.folder() / "pipe.log", &pipe);
  ASSERT_TRUE(eventually([&] { return plant.status().session != 0; }, kShort)) << stream.said();
  stream.send_signal(SIGINT);
  EXPECT_EQ(stream.wait(kShort), 1) << stream.said();
  EXPECT_NE(stream.said().find("interrupted"), std::string::npos) << stream.said();
}

/// The `meridian ctl` lines of the blocks of docs/operating.md that name their test as that one, as
/// words.
std::vector<std::vector<std::string>> documented_ctl_lines(const std::string& test) {
  std::ifstream page(std::string(MERIDIAN_SOURCE_DIR) + "/docs/operating.md");
  std::vector<std::vector<std::string>> lines;
  bool is_named = false;
  for (std::string text; std::getline(page, text);) {
    if (text.starts_with("<!-- walk:")) is_named = text == "<!-- walk: tested-by " + test + " -->";
    if (text == "```") is_named = false;
    if (!is_named || !text.starts_with("meridian ctl ")) continue;
    std::istringstream in(text);
    std::string word;
    in >> word;
    lines.emplace_back();
    while (in >> word && word != "#") lines.back().push_back(word);
  }
  return lines;
}

TEST_F(Tool, DoesWhatTheOperatingPageShowsInItsOrder) {
  const auto lines = documented_ctl_lines("Tool.DoesWhatTheOperatingPageShowsInItsOrder");
  ASSERT_GE(lines.size(), 41U);
  plant.start_service();
  plant.start_drives();
  for (const auto& words : lines) {
    if (words[1] == "start") {
      ASSERT_TRUE(plant.stream(small_program(12, 2000, 8), [&](const stream::Station& station) {
        return station.state() == stream::StationState::kComplete &&
               plant.status().state == State::kLoaded;
      })) << plant.station().message();
    }
    if (words[1] == "hold") {
      ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.service().said();
    }
    const bool is_move = words[1] == "move";  // begins in Ready, and is over there
    if (is_move && plant.status().state == State::kOff) {
      Process enable = run({"ctl", "enable", "--wait", "Ready"});
      ASSERT_EQ(enable.wait(kLong), 0) << enable.said() << plant.service().said();
    }
    Process tool = run(words);
    EXPECT_EQ(tool.wait(kLong), 0) << words[1] << ": " << tool.said() << plant.service().said();
    if (is_move) {
      ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.service().said();
    }
  }
}

TEST_F(Tool, RefusesInputBeforeTheMachineSeesIt) {
  plant.start_service();
  Process stream = run({"stream", part("far.apt", kPartOutOfTravel)});
  EXPECT_EQ(stream.wait(kShort), 3) << stream.said();
  EXPECT_NE(stream.said().find("far.apt:5: b3 at 2000 mm"), std::string::npos) << stream.said();
  EXPECT_EQ(plant.status().session, 0u);
}

struct BadFile {
  const char* name;
  std::string text;
  const char* words;
};

std::vector<BadFile> bad_files() {
  const std::string good = kGoodPart;
  return {{"truncated.apt", good.substr(0, good.find("GOTO/20,20") + 10),
           "truncated.apt:6: GOTO needs 3 or 6 numbers"},
          {"binary.apt", std::string("PK\x03\x04\0\0\x01\xff", 8), "a ZIP archive"},
          {"noise.apt", std::string("PARTNO\n\0\x01\x02\0\xfe\0\0", 14), "binary data"},
          {"empty.apt", "", "the file is empty"},
          {"feedless.apt", "UNITS/MM\nGOTO/0,0,150,0,0,1\nFINI\n", "no FEDRAT before it"},
          {"axisless.apt", "UNITS/MM\nFEDRAT/6000\nGOTO/0,0,150,0,0.6,0.8\nGOTO/20,0,150\nFINI\n",
           "a point without a tool axis after a tilted one"},
          {"undecided.nc", "N10 G21 G90\nN20 G1 X1. Y2. Z3. F500\nM30\n", "this is an NC program"},
          {"macro.nc", "%\nO1000\nN10 #1=5\nN20 G1 X#1 Y2. Z3. F500\nM30\n%\n", "a variable (#)"}};
}

TEST_F(Tool, RefusesFilesThatAreNoCLFilesInWordsAndWithoutMotion) {
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  const auto before = plant.status().joints;
  for (const BadFile& bad : bad_files()) {
    SCOPED_TRACE(bad.name);
    Process stream = run({"stream", part(bad.name, bad.text)});
    EXPECT_EQ(stream.wait(kShort), 3) << stream.said();
    EXPECT_NE(stream.said().find(bad.words), std::string::npos) << stream.said();
    EXPECT_NE(stream.said().find(bad.name), std::string::npos) << stream.said();
  }
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_EQ(plant.status().session, 0U);
  EXPECT_EQ(plant.status().blocks_received, 0U);
  EXPECT_EQ(plant.status().state, State::kReady);
  EXPECT_EQ(plant.status().joints, before);
}

TEST_F(Tool, ReportsWhatTheMachineRefusesWithoutPreflight) {
  plant.start_service();
  Process stream = run({"stream", part("far.apt", kPartOutOfTravel), "--no-preflight"});
  EXPECT_EQ(stream.wait(kShort), 4) << stream.said();
  EXPECT_NE(stream.said().find("line 5, block 1: b3 at 2000 mm"), std::string::npos)
      << stream.said();
}

TEST_F(Tool, ExitCodesOfCtlAndStatus) {
  Process alone = run({"status", "--timeout", "0.5"});
  EXPECT_EQ(alone.wait(kShort), 5) << alone.said();
  plant.start_service();
  Process status = run({"status", "--json"});
  EXPECT_EQ(status.wait(kShort), 0) << status.said();
  EXPECT_NE(status.said().find("\"state\":\"Off\""), std::string::npos) << status.said();
  Process start = run({"ctl", "start"});
  EXPECT_EQ(start.wait(kShort), 4) << start.said();
  EXPECT_NE(start.said().find("refused: "), std::string::npos) << start.said();
  Process wait = run({"ctl", "hold", "--wait", "Held"});
  EXPECT_EQ(wait.wait(kShort), 4) << wait.said();
  Process never = run({"ctl", "disable", "--wait", "Ready", "--wait-time", "0.5"});
  EXPECT_EQ(never.wait(kShort), 1) << never.said();
}

}  // namespace
}  // namespace meridian::test
