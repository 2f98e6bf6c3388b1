// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "meridian/units.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/scratch.hpp"
#include "support/simulated_run.hpp"

namespace meridian::simulate {
namespace {

constexpr const char* kPart =
    "UNITS / MM\nMULTAX / ON\nFEDRAT / 2400, MMPM\n"
    "GOTO / 80, -40, 20, 0.2, 0, 0.979796\nGOTO / 95, -40, 20, 0.2, 0, 0.979796\n"
    "GOTO / 95, -39.5, 20, 0.1, 0.2, 0.974679\nGOTO / 94, -25, 18, 0, 0.2, 0.979796\n"
    "CIRCLE / 89, -25, 18, 0, 0, 1, 5\nGOTO / 84, -25, 18, 0, 0.2, 0.979796\n"
    "GOTO / 84, -25, 18, 0, -0.2, 0.979796\nGOTO / 60, -20, 18, 0.3, -0.2, 0.932738\n"
    "RAPID\nGOTO / 80, -25, 40, 0.01, 0, 0.99995\nFINI\n";

/// How often the machine was asked to hold while it ran at a rate, and how often it then came to
/// rest on the path and stayed where it was.
struct Holds {
  int asked = 0, held = 0;
};

Holds holds_in(const std::vector<CycleRecord>& records) {
  Holds holds;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const bool begins =
        records[i].state == State::kHolding && records[i - 1].state != State::kHolding;
    if (!begins) continue;
    ++holds.asked;
    while (i < records.size() && records[i].state == State::kHolding) ++i;
    if (i == records.size() || records[i].state != State::kHeld) continue;
    const JointVector rest = records[i].joints;
    bool is_still = true;
    for (; i < records.size() && records[i].state == State::kHeld; ++i) {
      is_still = is_still && records[i].joints == rest && records[i].rate == 0;
    }
    holds.held += is_still ? 1 : 0;
    --i;
  }
  return holds;
}

/// Holds, resumes and overrides at random cycles, several on their way at once: no limit is
/// exceeded, the path is kept and cut to its end.
TEST(HoldAndOverride, AtAnyCycleKeepPathAndLimits) {
  constexpr std::uint32_t kSeed = 17;
  constexpr int kRuns = test::kIsTimed ? 30 : 6;
  std::printf("seed %u, %d runs\n", kSeed, kRuns);
  std::mt19937 random(kSeed);
  const auto draw = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  const test::Scratch recording(".csv");
  int held = 0;
  std::size_t slowed = 0;
  for (int n = 0; n < kRuns; ++n) {
    MachineModel model = test::lai_machine();
    const std::int64_t periods[] = {250'000, 1'000'000, 4'000'000};
    model.cycle_ns = periods[n % 3];
    const record::CheckedPath path = test::path_of(kPart, model);
    const int whole = static_cast<int>(6'000'000'000 / model.cycle_ns);
    SimulateOptions simulation;
    std::int64_t cycle = draw(1, whole / 2);
    double feed_override = 1;
    for (int i = draw(1, 6); i > 0; --i) {
      if (draw(0, 2) == 0) {
        feed_override = draw(1, 10) / 10.0;
        simulation.events.verbs.push_back({cycle, Verb::kFeedOverride, feed_override});
      } else {
        simulation.events.verbs.push_back({cycle, Verb::kHold, 0});
        cycle += draw(1, whole / 8);
        simulation.events.verbs.push_back({cycle, Verb::kResume, 0});
        // The hold may not be over yet: refused then; once more later.
        cycle += whole / 5;
        simulation.events.verbs.push_back({cycle, Verb::kResume, 0});
      }
      cycle += draw(0, whole / 8);
    }
    const test::SimulatedRun run = test::run_simulation(kPart, model, simulation);
    ASSERT_EQ(run.report.outcome, Outcome::kDone) << n << "\n" << to_text(run.report, model);
    const Holds holds = holds_in(run.records);
    EXPECT_EQ(holds.held, holds.asked) << "run " << n << ": a hold ends at rest, and rests";
    held += holds.held;
    for (const CycleRecord& record : run.records) {
      EXPECT_GE(record.rate, 0) << "run " << n << " cycle " << record.setpoint.cycle;
      slowed += record.state == State::kRunning && record.rate > 0 && record.rate < 1 ? 1U : 0U;
    }
    record::CheckOptions options;
    options.tip_tolerance_mm = 1e-3;
    options.axis_tolerance_rad = units::rad_from_deg(1e-3);
    const record::CheckReport report =
        test::check_records(run.records, path, model, options, recording.path());
    ASSERT_TRUE(report.passed()) << "run " << n << "\n"
                                 << to_text(run.report, model) << to_text(report);
  }
  std::printf("%d holds came to rest, %zu cycles ran at an override\n", held, slowed);
  EXPECT_GT(held, kRuns / 2) << "most runs were held while they ran";
  EXPECT_GT(slowed, 33U * kRuns);
}

}  // namespace
}  // namespace meridian::simulate
