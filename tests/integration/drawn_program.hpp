// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "meridian/cycle/guard.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/station/preflight.hpp"
#include "support/draws.hpp"
#include "support/simulated_run.hpp"
#include "support/text_file.hpp"

/// Drawn programs on a machine that is narrowed, and on the whole one: preflight, planner and the
/// guard of the cycle say the same. MERIDIAN_SETUP_LIMITS=1000 in the environment for more of them.
namespace meridian::test {

using Engine = std::mt19937_64;

/// Six cuts about a point of the table, the axis tilted by up to 40 degrees.
[[nodiscard]] inline std::string drawn_program(Engine& engine) {
  std::uniform_real_distribution<double> coordinate(-80, 80), tilt(0, 0.7), around(-3.1, 3.1);
  std::string text = "PARTNO LIMITS\nUNITS/MM\nFEDRAT/20000,MMPM\n";
  for (int block = 0; block < 6; ++block) {
    const double t = tilt(engine), a = around(engine);
    char line[160];
    std::snprintf(line, sizeof line, "GOTO/%.4f,%.4f,%.4f,%.6f,%.6f,%.6f\n", coordinate(engine),
                  coordinate(engine), coordinate(engine) / 4, std::sin(t) * std::cos(a),
                  std::sin(t) * std::sin(a), std::cos(t));
    text += line;
  }
  return text + "FINI\n";
}

/// Whether the guard stops by `alarm` anywhere on these setpoints.
[[nodiscard]] inline bool is_stopped(const std::vector<CycleRecord>& records,
                                     const MachineModel& model, Alarm alarm) {
  const double period_s = static_cast<double>(model.cycle_ns) * 1e-9;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const Setpoint& now = records[i].setpoint;
    const GuardVerdict verdict =
        alarm == Alarm::kTipBox
            ? check_tip_box(model, model.tool_length_mm, records[i].joints, records[i - 1].joints)
            : check(model, now.position, now.velocity, records[i - 1].setpoint.position, period_s);
    if (verdict.alarm == alarm) return true;
  }
  return false;
}

/// One program on both machines.
struct DrawnRun {
  MachineModel narrowed;
  SimulatedRun run, whole;
  bool is_done = false;  ///< `run`, to its end
};

/// A program that is done kept its box: the guard is silent, and `nearest`, how deep its setpoints
/// come into what is forbidden, is no more than `rounding`. One that is refused would not have kept
/// it, or would have come near to it: boxes are checked with what a path bends by between samples.
template <class Nearest>
void expect_box_kept(const DrawnRun& drawn, Alarm alarm, const Nearest& nearest, double rounding) {
  constexpr double kNear = 5e-3;  // mm, rad
  if (drawn.is_done) {
    EXPECT_FALSE(is_stopped(drawn.run.records, drawn.narrowed, alarm));
    EXPECT_LE(nearest(drawn.run.records, drawn.narrowed), rounding);
    return;
  }
  EXPECT_TRUE(is_stopped(drawn.whole.records, drawn.narrowed, alarm) ||
              nearest(drawn.whole.records, drawn.narrowed) > -kNear)
      << drawn.run.report.reason;
}

struct DrawnCounts {
  int programs = 0, run = 0, refused_first = 0, refused_between = 0;
};

/// Programs of `seed` on trunnion-ac, narrowed by `narrow(own, engine)`: what preflight refuses
/// does not run, the guard is silent; `check_run(run)` says the rest of each.
template <class Narrow, class CheckRun>
void check_drawn_programs(unsigned seed, Narrow narrow, CheckRun check_run, DrawnCounts& counts) {
  counts.programs = number_of("MERIDIAN_SETUP_LIMITS", 24);
  Engine engine(seed);
  const MachineModel own =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  for (int n = 0; n < counts.programs; ++n) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", program " << n);
    const std::string text = drawn_program(engine);
    DrawnRun drawn;
    drawn.narrowed = narrow(own, engine);
    const TextFile part(text);
    const auto preflight = stream::preflight(
        part.path(), {}, stream::PreflightMachine{drawn.narrowed, ToolTable(), ""});
    drawn.run = run_simulation(text, drawn.narrowed);
    drawn.whole = run_simulation(text, own);
    ASSERT_EQ(drawn.whole.report.outcome, simulate::Outcome::kDone) << drawn.whole.report.reason;
    ASSERT_NE(drawn.run.report.outcome, simulate::Outcome::kFault)
        << "the guard fired: " << drawn.run.report.reason;
    drawn.is_done = drawn.run.report.outcome == simulate::Outcome::kDone;
    if (preflight.is_refused) {
      ASSERT_FALSE(drawn.is_done) << "preflight refused what runs";
    }
    if (!drawn.is_done) {
      ASSERT_EQ(drawn.run.report.outcome, simulate::Outcome::kRefused);
    }
    check_run(drawn);
    counts.run += drawn.is_done ? 1 : 0;
    counts.refused_first += preflight.is_refused ? 1 : 0;
    counts.refused_between += !drawn.is_done && !preflight.is_refused ? 1 : 0;
  }
  std::printf("%d of %d programs run, %d refused by preflight, %d on the way between blocks\n",
              counts.run, counts.programs, counts.refused_first, counts.refused_between);
}

}  // namespace meridian::test
