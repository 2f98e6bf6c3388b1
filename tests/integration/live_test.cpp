// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "integration/live_run.hpp"
#include "meridian/cycle/drive_state.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "support/text_file.hpp"

namespace meridian::test {
namespace {

TEST(Live, EqualsTheSimulationBitForBitOnEveryCycleThatWasSent) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 16);
  LiveRun live;
  live.wire = (plant.folder() / "wire.csv").string();
  run_and_check(plant, part, live);
  expect_on_wire(plant, live);
}

/// A session that asks for what the machine's file does not have: on through blocks, other
/// tolerances. Corners are rounded and the pole is passed; a dwell and an action part the runs.
TEST(Live, RunsOnThroughBlocksAsItsSessionAsksAndEqualsTheSimulation) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 24);
  LiveRun live;
  live.reader = {"--tip-tolerance-mm", "0.02", "--axis-tolerance-deg", "0.2"};
  live.station = {"--transition", "smooth"};
  const std::string simulated = simulate_part(plant, part, live, live.station);
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated));
  expect_checked(plant, part, live);
  const auto smooth_size = std::filesystem::file_size(simulated);
  EXPECT_LT(smooth_size, std::filesystem::file_size(simulate_part(plant, part, live)))
      << "it stopped at every block";
}

/// Round a cone, `degrees` of azimuth in all: C follows.
std::string cone_text(double degrees) {
  const ToolPose home = [] {
    const MachineModel model = config::load_machine(machine_file());
    return forward(model, model.tool_length_mm, JointVector{});
  }();
  std::string text = "PARTNO ROUND A CONE\nUNITS/MM\nMULTAX/ON\nFEDRAT/6000,MMPM\n";
  for (double at = 0; at <= degrees; at += 4) {
    const double azimuth = units::rad_from_deg(at);
    char line[160];
    std::snprintf(line, sizeof line, "GOTO/%.6f,%.6f,%.6f,%.9f,%.9f,%.9f\n",
                  home.tip[0] + 10 * std::cos(azimuth), home.tip[1] + 10 * std::sin(azimuth),
                  home.tip[2] - 20, std::sin(0.2) * std::cos(azimuth),
                  std::sin(0.2) * std::sin(azimuth), std::cos(0.2));
    text += line;
  }
  return text + "FINI\n";
}

/// C turns farther than its travel: it is turned back off the part by half a turn, to the other
/// branch, live as simulated.
TEST(Live, TurnsCBackOffThePartAndEqualsTheSimulation) {
  Plant plant;
  ASSERT_NO_FATAL_FAILURE(plant.change_machine(
      {{"-720, 720", "-200, 200"},
       {"policy = \"refuse\"", "policy = \"retract\""},
       {"# retract_mm = 50", "retract_mm = 15"},
       {"\\nvelocity_deg_per_s = 60", "\nvelocity_deg_per_s = 180"},
       {"\\nacceleration_deg_per_s2 = 600", "\nacceleration_deg_per_s2 = 1200"},
       {"\\njerk_deg_per_s3 = 12000", "\njerk_deg_per_s3 = 48000"}}));
  const std::string part = (plant.folder() / "part.cls").string();
  std::ofstream(part) << cone_text(460);
  LiveRun live;
  live.station = {"--transition", "smooth"};
  const std::string simulated = simulate_part(plant, part, live, live.station);
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated));
  expect_checked(plant, part, live);
  const MachineModel model = config::load_machine(plant.machine());
  auto recording = record::RecordingReader::open(plant.recording(), model);
  ASSERT_TRUE(recording);
  std::vector<double> turned;
  for (record::RecordingRow row; recording->next(row).value_or(false);) {
    if (row.kind == MotionKind::kRewind) turned.push_back(row.joints[3]);
  }
  ASSERT_FALSE(turned.empty()) << "C was not turned back";
  EXPECT_NEAR(turned.front() - turned.back(), std::numbers::pi, 1e-3) << "to the other branch";
}

/// Median and p99 of the computation times in the recording of `plant`, ns, and how many of the
/// periods between its first and last row were executed.
struct CycleFigures {
  std::int64_t p50_ns = 0, p99_ns = 0;
  double executed = 0;
};

CycleFigures cycle_figures(const Plant& plant) {
  std::ifstream recording(plant.recording());
  std::string line;
  std::getline(recording, line);
  std::vector<std::int64_t> times_ns;
  std::int64_t first = -1, last = -1;
  while (std::getline(recording, line)) {
    times_ns.push_back(std::stoll(line.substr(line.rfind(',') + 1)));
    last = std::stoll(line);
    if (first < 0) first = last;
  }
  if (times_ns.empty()) return {};
  std::sort(times_ns.begin(), times_ns.end());
  return {times_ns[times_ns.size() / 2], times_ns[times_ns.size() * 99 / 100],
          static_cast<double>(times_ns.size()) / static_cast<double>(last - first + 1)};
}

/// The shortest and the longest cycle that a machine file may ask for.
class LiveAtCycle : public testing::TestWithParam<int> {};

TEST_P(LiveAtCycle, KeepsItsRateAndEqualsTheSimulation) {
  const int cycle_us = GetParam();
  Plant plant;
  ASSERT_NO_FATAL_FAILURE(plant.set_cycle_us(cycle_us));
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 8);
  run_and_check(plant, part, {});
  const CycleFigures figures = cycle_figures(plant);
  std::printf(
      "cycle of %d us: %.2f %% of the periods executed, computation p50 %.1f us, p99 %.1f us\n",
      cycle_us, 100 * figures.executed, 1e-3 * static_cast<double>(figures.p50_ns),
      1e-3 * static_cast<double>(figures.p99_ns));
  EXPECT_GT(figures.executed, 0.5) << "a busy host steals some periods, not most of them";
  EXPECT_GT(figures.p50_ns, 0);
  EXPECT_LT(figures.p50_ns, 1000 * cycle_us / 4);
}

INSTANTIATE_TEST_SUITE_P(Cycle, LiveAtCycle, testing::Values(125, 4000),
                         [](const testing::TestParamInfo<int>& cycle) {
                           return std::to_string(cycle.param) + "us";
                         });

/// The host takes the processor away from the service, for less than drives bridge.
void stall(Plant& plant) {
  plant.service().send_signal(SIGSTOP);
  std::this_thread::sleep_for(milliseconds(20));
  plant.service().send_signal(SIGCONT);
}

/// Of the two stalls at least the first has left a trace, which shows the late cycle as such.
void expect_trace_of_stall(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    ++count;
    const std::string trace = read_text(entry.path());
    EXPECT_NE(trace.find("\"slow: cycle "), std::string::npos) << trace.substr(0, 2000);
    for (const char* const name : {"wake-up", "step", "DDS write", "feedback"}) {
      EXPECT_NE(trace.find("{\"name\": \"" + std::string(name)), std::string::npos) << name;
    }
    if (std::system("python3 --version > /dev/null 2>&1") != 0) continue;
    const std::string parse = "python3 -m json.tool '" + entry.path().string() + "' > /dev/null";
    EXPECT_EQ(std::system(parse.c_str()), 0) << trace.substr(0, 2000);
  }
  EXPECT_GE(count, 1U) << "no trace in " << folder;
}

/// An operator who holds, resumes and turns the override while the program runs, on a host that
/// takes periods away while the machine changes its speed.
void operate(Plant& plant) {
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kFeedOverride, 0.45));
  stall(plant);
  std::this_thread::sleep_for(milliseconds(400));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kFeedOverride, 1.0));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume));
  stall(plant);
  std::this_thread::sleep_for(milliseconds(350));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kFeedOverride, 0.8));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kRapidOverride, 0.5));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kFeedOverride, 1.5));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume));
}

TEST(Live, IsReplayedBitForBitFromTheOperatorEventsBesideItsRecording) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  std::ofstream(part) << "PARTNO LONG CUTS\nUNITS/MM\nSPINDL/8000,RPM,CLW\nFEDRAT/2000,MMPM\n"
                      << cl_text(small_program(20, 2000, 8)) << "FINI\n";
  const auto traces = plant.folder() / "traces";
  LiveRun live;
  live.settings = "[trace]\nfolder = \"" + traces.string() + "\"\nlate_us = 10000\nevery_s = 0\n";
  live.operate = [&plant] { operate(plant); };
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  expect_trace_of_stall(traces);
  const std::string events = plant.folder() / "recording.events.csv";
  EXPECT_NE(read_text(events).find("feed_planned,1.5,"), std::string::npos);
  expect_same(plant, simulate_part(plant, part, live, {"--events", events}));
  expect_checked(plant, part, live);  // the feed times the override in force
}

/// Sends on from after a block; what follows may not have been planned yet.
void send_on(Plant& plant, Verb verb) { plant.must(verb, 0, Refusal::kNoProgram); }

/// An operator who steps through five blocks, lets the program run up to the first optional stop,
/// through the second, and steps through two somewhere in the last cuts.
void step_through(Plant& plant) {
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kSingleBlock, 1));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kOptionalStop, 1));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  std::uint64_t block = UINT64_MAX;  // in front of the first
  const auto rests_after_another = [&block](const dds::Status& status) {
    return status.state == State::kStepping && status.block != block;
  };
  for (int n = 0; n < 5; ++n) {
    ASSERT_TRUE(plant.runs_until(rests_after_another)) << plant.standing();
    EXPECT_TRUE(plant.status().is_single_block && plant.status().stops_at_optional);
    EXPECT_EQ(plant.status().block, block + 1);
    block = plant.status().block;
    if (n == 4) {
      ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kSingleBlock, 0));
    }
    ASSERT_NO_FATAL_FAILURE(send_on(plant, n % 2 == 0 ? Verb::kStart : Verb::kResume));
  }
  ASSERT_TRUE(plant.runs_until([](const auto& status) { return status.state == State::kHeld; }))
      << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kOptionalStop, 0));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume));
  ASSERT_TRUE(plant.runs_until(
      [block](const dds::Status& status) {
        return status.block > block + 16 && status.state == State::kRunning;
      },
      milliseconds(15'000)))
      << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kSingleBlock, 1));
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(plant.runs_until(rests_after_another)) << plant.standing();
    block = plant.status().block;
    if (n == 1) {
      ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kSingleBlock, 0));
    }
    ASSERT_NO_FATAL_FAILURE(send_on(plant, Verb::kResume));
  }
}

TEST(Live, RestsBehindBlocksAndAtOptionalStopsAndIsReplayedBitForBit) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  const auto blocks = small_program(50, 2000, 4);
  const auto first = blocks.begin(), third = blocks.end();
  const auto middle = first + 10, second = first + 16;
  std::ofstream(part) << "PARTNO STEPPED\nUNITS/MM\nFEDRAT/2000,MMPM\n"
                      << cl_text({first, middle}) << "OPSTOP\n"
                      << cl_text({first, second}, 10) << "OPSTOP\n"
                      << cl_text({first, third}, 16) << "FINI\n";
  LiveRun live;
  live.station = {"--transition", "smooth"};
  live.operate = [&plant] { step_through(plant); };
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  const std::string events = plant.folder() / "recording.events.csv";
  expect_same(plant,
              simulate_part(plant, part, live, {"--transition", "smooth", "--events", events}));
  expect_checked(plant, part, live);
}

/// What drives reported, every sample of it.
struct Stand {
  explicit Stand(Plant& plant) : reports(plant.participant()) {}
  void look(const MachineModel& model) {
    for (dds::DriveFeedback report; reports.take(report); ++seen) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
        moved = std::max(moved, std::abs(report.position[i] - model.joints[i].home));
        were_on |= drive_state(report.statusword[i]) == DriveState::kOperationEnabled;
      }
    }
  }
  dds::Reader<dds::DriveFeedback> reports;
  double moved = 0;
  bool were_on = false;
  int seen = 0;
};

/// Nobody awaits its actions, no drive is there; those that come in the middle of it stay off.
TEST(Live, CutsDryWithoutDrivesAsTheSimulationDoesAndDrivesThatComeStandStill) {
  Plant plant;
  const MachineModel model = config::load_machine(plant.machine());
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 16);
  Stand stand(plant);
  LiveRun live;
  live.is_dry_run = true;
  live.wire = (plant.folder() / "wire.csv").string();
  live.operate = [&] {
    EXPECT_TRUE(plant.status().is_dry_run);
    plant.start_drives();
    ASSERT_TRUE(eventually([&] { return stand.look(model), stand.seen > 0; }));
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  };
  live.watch = [&] { stand.look(model); };
  ASSERT_NO_FATAL_FAILURE(run_and_check(plant, part, live));
  EXPECT_GT(stand.seen, 100);
  EXPECT_EQ(stand.moved, 0);
  EXPECT_FALSE(stand.were_on);
  expect_on_wire(plant, live);
  auto rows = record::RecordingReader::open(plant.recording(), model);
  for (record::RecordingRow row; rows && rows->next(row).value_or(false);) {
    ASSERT_EQ(row.flags & kSetpointEnabled, 0) << row.cycle;
  }
}

}  // namespace
}  // namespace meridian::test
