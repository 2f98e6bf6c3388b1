// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/scratch.hpp"
#include "support/simulated_run.hpp"

namespace meridian::simulate {
namespace {

using record::CheckReport;
using test::check_records;
using test::path_of;
using test::run_simulation;
using test::SimulatedRun;

/// A cycle in the middle of the cut, counted from the start.
[[nodiscard]] std::int64_t middle_of(const SimulatedRun& run) {
  return static_cast<std::int64_t>((run.report.approach_s + 0.5 * run.report.program_s) /
                                   run.report.cycle_s);
}

/// Lines, a tilt, an arc of half a turn, a rapid.
constexpr const char* kPart =
    "UNITS / MM\nMULTAX / ON\nFEDRAT / 1200, MMPM\n"
    "GOTO / 80, -40, 20, 0.2, 0, 0.979796\nGOTO / 95, -40, 20, 0.2, 0, 0.979796\n"
    "GOTO / 95, -25, 18, 0.1, 0.2, 0.974679\nGOTO / 90, -25, 18, 0, 0.2, 0.979796\n"
    "CIRCLE / 85, -25, 18, 0, 0, 1, 5\nGOTO / 80, -25, 18, 0, 0.2, 0.979796\n"
    "RAPID\nGOTO / 80, -25, 40, 0, 0, 1\nFINI\n";

class Simulate : public ::testing::Test {
 protected:
  Simulate() {
    options.tip_tolerance_mm = 1e-3;
    options.axis_tolerance_rad = units::rad_from_deg(1e-3);
  }

  [[nodiscard]] CheckReport check(const SimulatedRun& run, const char* text,
                                  const ToolTable& tools = {}) const {
    return check_records(run.records, path_of(text, model, tools), model, options,
                         recording.path());
  }

  MachineModel model = test::lai_machine();
  record::CheckOptions options;
  test::Scratch recording{".csv"};
};

TEST_F(Simulate, CutsTheWholePathInsideEveryLimit) {
  const SimulatedRun run = run_simulation(kPart, model);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_EQ(run.report.motion_blocks, 6U);
  EXPECT_EQ(run.report.cycles, run.records.size());
  EXPECT_GT(run.report.approach_s, 0.1);
  EXPECT_GT(run.report.program_s, run.report.at_feed_s);
  const CheckReport report = check(run, kPart);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_GT(report.feed.value, 0.9);
  EXPECT_NEAR(report.cut_s, run.report.program_s, 0.01);
}

TEST_F(Simulate, EndsWhereTheMachineIsSwitchedOffRightBehindItsProgram) {
  const SimulatedRun free = run_simulation(kPart, model);
  const auto last = static_cast<std::int64_t>(free.report.cycles);
  SimulateOptions events;
  for (int n = 40; n > 0; --n) events.events.verbs.push_back({last - n, Verb::kDisable, 0});
  const SimulatedRun run = run_simulation(kPart, model, events);
  EXPECT_EQ(run.report.outcome, Outcome::kDone);
  EXPECT_EQ(run.records.back().state, State::kOff);
  EXPECT_LT(run.report.cycles, free.report.cycles + 100);
}

TEST_F(Simulate, EndsWhereTheProgramSwitchesTheMachineOffBehindItsEnd) {
  std::string text = kPart;
  text.replace(text.rfind("FINI"), 4, "END\nSPINDL/OFF\nCOOLNT/OFF\nFINI");
  const SimulatedRun run = run_simulation(text, model);
  EXPECT_EQ(run.report.outcome, Outcome::kDone);
  EXPECT_EQ(run.report.blocks_done, 8U);  // 6 of motion, 2 actions
}

TEST_F(Simulate, IsCheckedByThePolesToleranceWhichTheVerdictNames) {
  MachineModel bench = test::bench_machine();
  bench.tolerances.pole_axis_rad = units::rad_from_deg(1.5);
  const SimulatedRun run = run_simulation(kPart, bench);
  const CheckReport wide =
      check_records(run.records, path_of(kPart, bench), bench, {}, recording.path());
  EXPECT_NE(to_text(wide).find("tolerance 0.1 deg, 1.5 deg within 22.9 deg of the pole"),
            std::string::npos)
      << to_text(wide);
  bench.pole_policy = PolePolicy::kExact;
  const CheckReport exact =
      check_records(run.records, path_of(kPart, bench), bench, {}, recording.path());
  EXPECT_EQ(to_text(exact).find("of the pole"), std::string::npos) << to_text(exact);
}

TEST_F(Simulate, JoinsBlocksAsASessionAsksInsteadOfAsTheMachineSays) {
  MachineModel smooth = model;
  smooth.transition = Transition::kSmooth;
  smooth.tolerances.tip_mm = 0.05;
  SimulateOptions simulation;
  simulation.settings = {Transition::kSmooth, 0.05, 0};
  const SimulatedRun asked = run_simulation(kPart, model, simulation);
  const SimulatedRun own = run_simulation(kPart, smooth), plain = run_simulation(kPart, model);
  EXPECT_EQ(asked.records.size(), own.records.size());
  EXPECT_LT(asked.records.size(), plain.records.size());
  simulation.settings.tip_tolerance_mm = 0.001;
  EXPECT_GT(run_simulation(kPart, model, simulation).records.size(), asked.records.size());
}

TEST_F(Simulate, SaysWhatTheStopsAtVerticesCostInExactStopAlone) {
  // Four blocks of 20 mm in a row: their rests cost more than those of one block of 80 mm.
  const std::string head = "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.6, 0.8\n";
  std::string text = head;
  for (int n = 1; n <= 4; ++n)
    text += "GOTO / " + std::to_string(80 - 20 * n) + ", -40, 20, 0, 0.6, 0.8\n";
  const SimulateReport four = run_simulation(text + "FINI\n", model).report;
  const SimulateReport one =
      run_simulation(head + "GOTO / 0, -40, 20, 0, 0.6, 0.8\nFINI\n", model).report;
  EXPECT_NEAR(four.vertex_stops_s, 4 * one.vertex_stops_s, 0.01);
  // The feed of 20 mm/s is reached in every block: what the rests cost is what they add.
  EXPECT_NEAR(four.program_s - one.program_s, 3 * one.vertex_stops_s, 0.02);
  EXPECT_NE(to_text(four, model).find("are stops at vertices"), std::string::npos);
  model.transition = Transition::kSmooth;
  const SimulateReport smooth = run_simulation(text + "FINI\n", model).report;
  EXPECT_EQ(smooth.vertex_stops_s, 0);
  EXPECT_EQ(to_text(smooth, model).find("are stops at vertices"), std::string::npos);
}

/// Moves, turns of the axis alone and both, each with a time of its own, that go to and fro.
[[nodiscard]] std::string in_inverse_time(std::uint32_t seed) {
  std::mt19937 engine(seed);
  const auto draw = [&](double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(engine));
  };
  std::string text = "UNITS / MM\nMULTAX / ON\n";
  double x = 80, y = -40, tilt = 0.3, side = 1;
  for (int n = 0; n < 50; ++n, side = -side) {
    const int kind = n % 5;
    const double length = kind == 1 ? 0 : draw(0.1, 15);
    const double before = tilt;
    if (kind != 2) tilt = std::clamp(tilt + side * draw(0.002, 0.3), 0.1, 0.9);
    const double turn = std::abs(tilt - before);
    (kind == 3 ? y : x) += side * length;
    char line[160];
    std::snprintf(
        line, sizeof line, "FEDRAT / INVERS, %.6f\nGOTO / %.9f, %.9f, 20, %.12f, 0, %.12f\n",
        60 * draw(2, 100) / std::hypot(length, 50 * turn), x, y, std::sin(tilt), std::cos(tilt));
    text += line;
  }
  return text + "FINI\n";
}

TEST_F(Simulate, CutsBlocksInInverseTimeAsCheckChecksThem) {
  for (JointSpec& joint : model.joints) {
    joint.limits.velocity *= 8;
    joint.limits.acceleration *= 40;
    joint.limits.jerk *= 200;
  }
  const auto programs = test::number_of<std::uint32_t>("MERIDIAN_INVERSE_PROGRAMS", 1);
  for (const Transition transition : {Transition::kSmooth, Transition::kExactStop}) {
    model.transition = transition;
    for (std::uint32_t seed = 1; seed <= programs; ++seed) {
      const std::string text = in_inverse_time(seed);
      const SimulatedRun run = run_simulation(text, model);
      ASSERT_EQ(run.report.outcome, Outcome::kDone) << run.report.reason;
      options = {};
      const CheckReport report = check(run, text.c_str());
      EXPECT_TRUE(report.passed()) << "seed " << seed << '\n' << to_text(report);
      EXPECT_GT(report.feed.value, 0.99);
    }
  }
}

TEST_F(Simulate, GivesTheSameBitsEveryTime) {
  const SimulatedRun one = run_simulation(kPart, model), two = run_simulation(kPart, model);
  ASSERT_EQ(one.records.size(), two.records.size());
  for (std::size_t i = 0; i < one.records.size(); ++i) {
    ASSERT_EQ(std::memcmp(&one.records[i].joints, &two.records[i].joints, sizeof(JointVector)), 0);
  }
}

TEST_F(Simulate, StartsWhereItsOptionsSay) {
  SimulateOptions simulation;
  simulation.start = JointVector{50, 60, 70, 0.5, 0.1, 0};
  const SimulatedRun run = run_simulation(kPart, model, simulation);
  EXPECT_EQ(run.records.front().joints, *simulation.start);
  EXPECT_EQ(run.report.outcome, Outcome::kDone);
  EXPECT_TRUE(check(run, kPart).passed());
}

TEST_F(Simulate, ReplaysHoldAndResumeWithinEveryLimit) {
  SimulateOptions simulation;
  const SimulatedRun plain = run_simulation(kPart, model);
  const std::int64_t middle = middle_of(plain);
  simulation.events.verbs = {{middle, Verb::kHold, 0}, {middle + 700, Verb::kResume, 0}};
  const SimulatedRun run = run_simulation(kPart, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_GT(run.report.program_s, plain.report.program_s + 0.4);
  const CheckReport report = check(run, kPart);
  EXPECT_TRUE(report.passed()) << to_text(report);
}

TEST_F(Simulate, ReplaysOverrides) {
  SimulateOptions simulation;
  const SimulatedRun plain = run_simulation(kPart, model);
  simulation.events.verbs = {{0, Verb::kFeedOverride, 0.5}};
  const SimulatedRun run = run_simulation(kPart, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kDone);
  EXPECT_GT(run.report.program_s, 1.7 * plain.report.program_s);
  options.feed_factor = 0.5;
  const CheckReport report = check(run, kPart);
  EXPECT_TRUE(report.passed()) << to_text(report);
}

TEST_F(Simulate, GoesOverLostPeriodsAsTheCycleDoesThatLosesThem) {
  SimulateOptions simulation;
  const std::int64_t middle = middle_of(run_simulation(kPart, model));
  // Cycles count from the one that takes the start: with three lost in front of it, from three
  // later.
  simulation.events.verbs = {{0, Verb::kFeedOverride, 0.4}, {middle + 3, Verb::kFeedOverride, 1}};
  const SimulatedRun whole = run_simulation(kPart, model, simulation);
  simulation.events.verbs.back().cycle = middle;
  simulation.events.losses = {{0, 3, true}, {middle - 400, 20, true}, {middle + 30, 17, true}};
  const SimulatedRun run = run_simulation(kPart, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_EQ(run.report.cycles, whole.report.cycles);
  EXPECT_EQ(run.records.size() + 40, whole.records.size());
  std::size_t at = 0;
  for (const CycleRecord& record : run.records) {
    while (whole.records[at].setpoint.cycle < record.setpoint.cycle) ++at;
    ASSERT_EQ(record.joints, whole.records[at].joints) << "cycle " << record.setpoint.cycle;
  }
  options.max_missing = 40;
  const CheckReport report = check(run, kPart);
  EXPECT_TRUE(report.passed()) << to_text(report);
}

TEST_F(Simulate, WaitsForActionsAsLongAsTheLiveRunDid) {
  constexpr const char* kWithSpindle =
      "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0, 1\nGOTO / 95, -40, 20\n"
      "SPINDL / 8000, CLW\nGOTO / 80, -40, 20\nFINI\n";
  const SimulatedRun at_once = run_simulation(kWithSpindle, model);
  SimulateOptions simulation;
  const auto late = static_cast<std::int64_t>(at_once.report.cycles) + 300;
  simulation.events.answers = {{late, true}};
  const SimulatedRun run = run_simulation(kWithSpindle, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_GT(run.report.waiting_s, at_once.report.waiting_s + 0.3);
  simulation.events.answers = {{late, false}};
  EXPECT_EQ(run_simulation(kWithSpindle, model, simulation).report.outcome, Outcome::kStopped);
}

TEST_F(Simulate, PlansForOverridesAboveTheFeedAsTheOperatorOrTheFileOfALiveRunSays) {
  model.max_feed_override = 1.5;
  SimulateOptions simulation;
  const SimulatedRun plain = run_simulation(kPart, model);
  simulation.events.verbs = {{-1, Verb::kFeedOverride, 1.4}};
  const SimulatedRun run = run_simulation(kPart, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kDone);
  EXPECT_LT(run.report.program_s, 0.97 * plain.report.program_s);
  const CheckReport report = check(run, kPart);
  EXPECT_FALSE(report.passed()) << to_text(report);
  options.overrides = {{1, 1.4}};
  EXPECT_TRUE(check(run, kPart).passed()) << to_text(check(run, kPart));
  simulation.events.feed_marks = {{true, 0, 0, 1}};  // the live planner was through before
  EXPECT_EQ(run_simulation(kPart, model, simulation).report.program_s, plain.report.program_s);
}

TEST_F(Simulate, RestsBehindABlockUntilItsEventsSendItOnAndNoLonger) {
  SimulateOptions simulation;
  const auto late = static_cast<std::int64_t>(run_simulation(kPart, model).report.cycles);
  simulation.events.verbs = {{-1, Verb::kSingleBlock, 1}, {late, Verb::kResume, 0}};
  for (const bool is_aborted : {false, true}) {
    if (is_aborted) simulation.events.verbs.push_back({3 * late, Verb::kAbort, 0});
    const SimulatedRun run = run_simulation(kPart, model, simulation);
    EXPECT_EQ(run.report.outcome, Outcome::kStopped);
    EXPECT_EQ(run.report.blocks_done, 2U);
    EXPECT_EQ(run.records.back().state, is_aborted ? State::kReady : State::kStepping);
  }
}

TEST_F(Simulate, GoesOnFromAProgramStopWhenTheOperatorOfTheEventsDid) {
  constexpr const char* kWithStop =
      "UNITS / MM\nFEDRAT / 300, MMPM\nGOTO / 80, -40, 20, 0, 0, 1\nSTOP\nGOTO / 95, -40, 20\n"
      "FINI\n";
  const SimulatedRun at_once = run_simulation(kWithStop, model);
  ASSERT_EQ(at_once.report.outcome, Outcome::kDone);
  SimulateOptions simulation;
  const auto late = static_cast<std::int64_t>(at_once.report.cycles) + 400;
  simulation.events.verbs = {{late, Verb::kResume, 0}, {late + 100, Verb::kFeedOverride, 0.5}};
  const SimulatedRun run = run_simulation(kWithStop, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_GT(run.report.program_s, at_once.report.program_s + 0.5);
  std::size_t slowed = 0;
  for (const CycleRecord& record : run.records) slowed += record.rate > 0.4 && record.rate < 0.6;
  EXPECT_GT(slowed, 100U) << "the override meets the cut after the stop";
}

TEST_F(Simulate, EndsWhereTheOperatorLeavesIt) {
  options.allow_unfinished = true;
  const std::int64_t middle = middle_of(run_simulation(kPart, model));
  for (const OperatorEvent& event :
       {OperatorEvent{middle, Verb::kHold, 0}, OperatorEvent{middle, Verb::kAbort, 0},
        OperatorEvent{middle, Verb::kFeedOverride, 0}}) {
    SimulateOptions simulation;
    simulation.events.verbs = {event};
    const SimulatedRun run = run_simulation(kPart, model, simulation);
    EXPECT_EQ(run.report.outcome, Outcome::kStopped) << to_text(run.report, model);
    const CheckReport report = check(run, kPart);
    EXPECT_TRUE(report.passed()) << to_text(report);
    EXPECT_GT(report.vertices, 1U);
    EXPECT_LT(report.vertices, 17U);
  }
}

TEST_F(Simulate, MayBeEndedInTheApproach) {
  SimulateOptions simulation;
  simulation.events.verbs = {{100, Verb::kAbort, 0}};
  const SimulatedRun run = run_simulation(kPart, model, simulation);
  EXPECT_EQ(run.report.outcome, Outcome::kStopped);
  EXPECT_FALSE(check(run, kPart).passed()) << "the path was never begun";
  options.allow_unfinished = true;
  const CheckReport report = check(run, kPart);
  EXPECT_TRUE(report.passed()) << to_text(report);
}

TEST_F(Simulate, RunsTheBlocksBeforeARefusedOneAndNamesIt) {
  const char* text =
      "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0, 1\nGOTO / 95, -40, 20\n"
      "GOTO / 95, -40, 1900\nGOTO / 96, -40, 20\nFINI\n";
  const SimulatedRun run = run_simulation(text, model);
  EXPECT_EQ(run.report.outcome, Outcome::kRefused);
  EXPECT_NE(run.report.reason.find("line 5"), std::string::npos) << run.report.reason;
  const ToolPose last = forward(model, model.tool_length_mm, run.records.back().joints);
  EXPECT_LT((last.tip - Vector3(95, -40, 20)).norm(), 1e-9);
}

TEST_F(Simulate, DoesNotMoveForAFileWhoseFirstBlockIsRefused) {
  const SimulatedRun run = run_simulation(
      "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 1900, 0, 0, 1\nFINI\n", model);
  EXPECT_EQ(run.report.outcome, Outcome::kRefused);
  for (const CycleRecord& record : run.records) {
    ASSERT_EQ(record.joints, run.records.front().joints);
  }
}

TEST_F(Simulate, DoesActionsAtOnceAndResumesAtStops) {
  const char* text =
      "UNITS / MM\nFEDRAT / 1200, MMPM\nSPINDL / 8000, CLW\nGOTO / 80, -40, 20, 0, 0, 1\n"
      "COOLNT / ON\nGOTO / 95, -40, 20\nSTOP\nGOTO / 95, -30, 20\nOPSTOP\nDELAY / 0.25\n"
      "GOTO / 90, -30, 20\nFINI\n";
  const SimulatedRun run = run_simulation(text, model);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_GT(run.report.waiting_s, 0.25);
  EXPECT_LT(run.report.waiting_s, 0.3);
  EXPECT_TRUE(check(run, text).passed()) << to_text(check(run, text));
  SimulateOptions simulation;
  simulation.has_action_peer = false;
  const SimulatedRun alone = run_simulation(text, model, simulation);
  EXPECT_EQ(alone.report.outcome, Outcome::kRefused);
  EXPECT_NE(alone.report.reason.find("action"), std::string::npos) << alone.report.reason;
}

TEST_F(Simulate, ChangesToolsOfItsTable) {
  const char* text =
      "UNITS / MM\nFEDRAT / 1200, MMPM\nGOTO / 80, -40, 20, 0, 0.1, 0.994987\n"
      "GOTO / 95, -40, 20, 0, 0.1, 0.994987\nLOADTL / 3\nGOTO / 95, -40, 30, 0, 0.1, 0.994987\n"
      "GOTO / 80, -40, 30, 0, 0.1, 0.994987\nFINI\n";
  const ToolTable tools({{3, 130, 8}});
  const SimulatedRun run = run_simulation(text, model, {}, tools);
  EXPECT_EQ(run.report.outcome, Outcome::kDone) << to_text(run.report, model);
  EXPECT_TRUE(check(run, text, tools).passed()) << to_text(check(run, text, tools));
  EXPECT_EQ(run_simulation(text, model).report.outcome, Outcome::kRefused) << "no such tool";
}

TEST_F(Simulate, NamesTheNearestLimit) {
  model.joints[3].limits.velocity = 0.05;  // C creeps
  const char* text =
      "UNITS / MM\nFEDRAT / 6000, MMPM\nGOTO / 80, -40, 20, 0.2, 0, 0.979796\n"
      "GOTO / 80, -40, 20, 0, 0.2, 0.979796\nFINI\n";
  const SimulatedRun run = run_simulation(text, model);
  EXPECT_GT(run.report.shares.joints[3][0], 9 * run.report.shares.cycles / 10);
  EXPECT_NE(to_text(run.report, model).find("theta1 velocity"), std::string::npos);
}

}  // namespace
}  // namespace meridian::simulate
