// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "integration/checked_part.hpp"
#include "integration/fault_kinds.hpp"
#include "integration/live_run.hpp"
#include "integration/plant.hpp"
#include "integration/witness.hpp"
#include "service/machine/file/machine_file.hpp"

/// A station that dies in the middle of a program with arcs, and what another one makes of the
/// rest.
namespace meridian::test {
namespace {

constexpr int kArcs = 7;
/// Half circles and lines in turns; the tool leans and does not turn.
[[nodiscard]] std::vector<std::string> part_with_arcs() {
  std::vector<std::string> lines{"PARTNO ARCS", "UNITS/MM", "FEDRAT/6000,MMPM"};
  const ClBlock begin = small_program(1, 6000)[0];
  const auto at = [&begin](double x) {
    char text[160];
    std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f", begin.tip_mm[0] + x, begin.tip_mm[1],
                  begin.tip_mm[2]);
    return std::string(text);
  };
  const std::string axis = ",0.173648177667,0,0.984807753012";
  lines.push_back("GOTO/" + at(0) + axis);
  for (int n = 0; n < kArcs; ++n) {
    const double x = 30.0 * n;
    lines.push_back("CIRCLE/" + at(x + 10) + ",0,0,1,10");
    lines.push_back("GOTO/" + at(x + 20) + axis);
    lines.push_back("GOTO/" + at(x + 30) + axis);
  }
  lines.emplace_back("FINI");
  return lines;
}

constexpr std::uint32_t kUpToArc = 9;  ///< line that ends the second of them
constexpr std::uint32_t kSent = 22;    ///< so many lines were sent

[[nodiscard]] std::string joined(const std::vector<std::string>& lines, std::size_t count) {
  std::string text;
  for (std::size_t n = 0; n < count; ++n) text += lines[n] + "\n";
  return text;
}

class StationDeath : public testing::TestWithParam<const char*> {
 protected:
  static constexpr milliseconds kLong{20'000};

  void SetUp() override {
    plant.change_machine({{"clearance_mm = [0-9]+", "clearance_mm = 5"}});
    std::ofstream(file()) << joined(lines, lines.size());
    plant.start_service({"--service", service_file(plant)});
    plant.start_drives();
    ASSERT_TRUE(plant.enable()) << plant.service().said();
  }
  [[nodiscard]] std::string file() const { return (plant.folder() / "arcs.cls").string(); }
  [[nodiscard]] std::vector<std::string> stream(const std::string& what) const {
    return {"meridian",     "stream",       what,       "--domain",
            plant.domain(), "--transition", GetParam(), "--wait-end"};
  }
  /// Starts a program whose station has sent all but the last arcs, and kills the station while the
  /// second one is cut.
  void lose_station() {
    InputPipe pipe;
    Process station(stream("-"), plant.folder() / "station.log", &pipe);
    pipe.write(joined(lines, kSent));
    ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_TRUE(eventually([&] { return witness.newest().line >= kUpToArc; }, kLong))
        << plant.standing();
    station.send_signal(SIGKILL);
    ASSERT_TRUE(station.wait(milliseconds(2000)));
  }
  /// Cuts the rest from `line` on and checks both.
  void go_on(std::uint32_t line) {
    PartCut first{.recording = plant.recording(), .is_finished = false};
    const dds::Status between = plant.status();
    end_at(first, between);
    PartCut second{
        .recording = plant.recording(), .from_line = line, .from_cycle = first.to_cycle + 1};
    auto words = stream(file());
    words.insert(words.end(), {"--from-line", std::to_string(line), "--station", "another"});
    Process other(words, plant.folder() / "other.log");
    ASSERT_TRUE(plant.wait_for(State::kLoaded)) << other.said() << plant.standing();
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
    ASSERT_EQ(other.wait(kLong), 0) << other.said() << plant.standing();
    ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
    end_at(second, plant.status(), cycles_lost(between));
    plant.service().send_signal(SIGTERM);
    ASSERT_EQ(plant.service().wait(milliseconds(8000)), 0) << plant.service().said();
    const MachineModel model = config::load_machine(plant.machine());
    const ToolTable none;
    const PartAsked part{model, none, file(), motion_lines(model, none, file())};
    const LinesCut before = check(part, first), after = check(part, second);
    EXPECT_EQ(after.last, part.motions.back());
    EXPECT_TRUE(after.is_last_done);
    expect_seam(part, before, after, line);
  }

  const std::vector<std::string> lines = part_with_arcs();
  Plant plant;
  Witness witness{plant.participant()};
};

class StationDeathInAnArc : public StationDeath {};

/// What a smooth plan holds back of the blocks that came (docs/motion.md, section 9) is not cut.
TEST_P(StationDeath, IsMadeUpForByAnotherStationFromWhereTheMachineStarved) {
  ASSERT_NO_FATAL_FAILURE(lose_station());
  const bool is_smooth = std::string(GetParam()) == "smooth";
  ASSERT_TRUE(plant.runs_until(
      [&](const auto& s) {
        return s.state == State::kStarved && (is_smooth || s.blocks_done == s.blocks_received);
      },
      kLong))
      << plant.standing();
  const std::uint32_t line = plant.status().line;
  EXPECT_GT(line, kUpToArc);
  EXPECT_EQ(line == kSent, !is_smooth);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
  go_on(is_smooth ? line : line + 1);
}

TEST_P(StationDeathInAnArc, AndAnAbortAreMadeUpForFromTheBeginOfTheArc) {
  ASSERT_NO_FATAL_FAILURE(lose_station());
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
  ASSERT_TRUE(eventually([&] {
    return plant.status().message.find(" was aborted in block ") != std::string::npos;
  })) << plant.standing();
  const std::string said = plant.status().message;
  const auto at = said.find(", line ");
  ASSERT_NE(at, std::string::npos) << said;
  const auto line = static_cast<std::uint32_t>(std::stoul(said.substr(at + 7)));
  EXPECT_GE(line, kUpToArc) << said;
  go_on(line);
}

/// Both ways of going from block to block where MERIDIAN_FAULT_MATRIX=all is in the environment.
[[nodiscard]] std::vector<const char*> transitions(const char* otherwise) {
  if (is_whole_matrix()) return {"smooth", "exact_stop"};
  return {otherwise};
}

[[nodiscard]] std::string name_of_transition(
    const testing::TestParamInfo<const char*>& transition) {
  return std::string(transition.param) == "smooth" ? "Smooth" : "ExactStop";
}

INSTANTIATE_TEST_SUITE_P(Of, StationDeath, testing::ValuesIn(transitions("exact_stop")),
                         name_of_transition);
INSTANTIATE_TEST_SUITE_P(Of, StationDeathInAnArc, testing::ValuesIn(transitions("smooth")),
                         name_of_transition);

}  // namespace
}  // namespace meridian::test
