// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>

#include "integration/drawn_program.hpp"
#include "meridian/cycle/guard.hpp"
#include "meridian/kinematics/soft_limits.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/preflight.hpp"
#include "support/draws.hpp"
#include "support/simulated_run.hpp"
#include "support/text_file.hpp"

/// Programs anywhere under soft limits anywhere: preflight, planner and the guard of the cycle say
/// the same. MERIDIAN_SETUP_LIMITS=1000 in the environment for more of them.
namespace meridian {
namespace {

using Engine = std::mt19937_64;

/// Limits of one to three joints, each a draw of its travel.
SoftLimits drawn_limits(const MachineModel& own, Engine& engine) {
  SoftLimits limits;
  const int count = 1 + static_cast<int>(engine() % 3);
  for (int n = 0; n < count; ++n) {
    const auto joint = static_cast<std::uint8_t>(engine() % static_cast<unsigned>(own.joint_count));
    const double reach = own.joints[joint].is_rotary ? 4 : 300;
    std::uniform_real_distribution<double> end(0, reach);
    const JointLimits& whole = own.joints[joint].limits;
    const double home = own.joints[joint].home;
    (void)limits.apply({LimitsWord::kSet, joint, std::max(whole.travel_min, home - end(engine)),
                        std::min(whole.travel_max, home + end(engine))},
                       own);
  }
  return limits;
}

/// Whether the guard stops anywhere on these setpoints.
bool is_stopped(const std::vector<CycleRecord>& records, const MachineModel& model) {
  const double period_s = static_cast<double>(model.cycle_ns) * 1e-9;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const Setpoint& now = records[i].setpoint;
    const GuardVerdict verdict =
        check(model, now.position, now.velocity, records[i - 1].setpoint.position, period_s);
    if (verdict.alarm == Alarm::kTravel) return true;
  }
  return false;
}

TEST(DrawnLimits, AreSeenByPreflightPlannerAndGuardAlike) {
  const int programs = test::number_of("MERIDIAN_SETUP_LIMITS", 24);
  constexpr unsigned kSeed = 20261127;
  Engine engine(kSeed);
  const MachineModel own =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  int run = 0, refused_first = 0, refused_between = 0;
  for (int n = 0; n < programs; ++n) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", program " << n);
    const std::string text = test::drawn_program(engine);
    const SoftLimits limits = drawn_limits(own, engine);
    MachineModel model = own;
    shrink_travel(model, travel_under(limits, own));
    const test::TextFile part(text);
    const auto preflight =
        stream::preflight(part.path(), {}, stream::PreflightMachine{model, ToolTable(), ""});
    const test::SimulatedRun limited = test::run_simulation(text, model);
    const test::SimulatedRun whole = test::run_simulation(text, own);
    ASSERT_EQ(whole.report.outcome, simulate::Outcome::kDone) << whole.report.reason;
    ASSERT_NE(limited.report.outcome, simulate::Outcome::kFault)
        << "the guard fired: " << limited.report.reason;
    const bool is_done = limited.report.outcome == simulate::Outcome::kDone;
    if (preflight.is_refused) {
      ASSERT_FALSE(is_done) << "preflight refused what runs";
    }
    if (!is_done) {
      ASSERT_EQ(limited.report.outcome, simulate::Outcome::kRefused);
      EXPECT_TRUE(is_stopped(whole.records, model)) << limited.report.reason;
    } else {
      EXPECT_FALSE(is_stopped(limited.records, model));
    }
    run += is_done ? 1 : 0;
    refused_first += preflight.is_refused ? 1 : 0;
    refused_between += !is_done && !preflight.is_refused ? 1 : 0;
  }
  std::printf("%d of %d programs run, %d refused by preflight, %d on the way between blocks\n", run,
              programs, refused_first, refused_between);
  EXPECT_GT(run, programs / 10);
  EXPECT_GT(refused_first, programs / 10);
}

}  // namespace
}  // namespace meridian
