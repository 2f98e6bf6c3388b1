// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>

#include "integration/drawn_program.hpp"
#include "meridian/cycle/guard.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/preflight.hpp"
#include "support/draws.hpp"
#include "support/simulated_run.hpp"
#include "support/text_file.hpp"

/// Programs anywhere among keep-out boxes anywhere: preflight, planner and the guard of the cycle
/// say the same. MERIDIAN_SETUP_LIMITS=1000 in the environment for more of them.
namespace meridian {
namespace {

/// One to four boxes of one to three joints, none of which holds home.
KeepOut drawn_keep_out(const MachineModel& own, std::mt19937_64& engine) {
  KeepOut out;
  JointVector home{};
  for (int i = 0; i < own.joint_count; ++i) home[i] = own.joints[i].home;
  const auto count = 1 + engine() % 4;
  while (out.boxes().size() < count) {
    KeepOutBox box;
    for (std::uint64_t n = 1 + engine() % 3; n > 0; --n) {
      const auto joint = static_cast<std::size_t>(engine() % 5);
      if (own.joints[joint].is_endless) continue;
      const bool is_rotary = own.joints[joint].is_rotary;
      std::uniform_real_distribution<double> middle(is_rotary ? -0.8 : -150, is_rotary ? 0.8 : 150);
      std::uniform_real_distribution<double> half(0.001, is_rotary ? 0.3 : 60);
      const double at = home[joint] + middle(engine), by = half(engine);
      box.joints |= 1U << joint;
      box.min[joint] = at - by;
      box.max[joint] = at + by;
    }
    if (box.joints != 0 && depth_inside(box, home) < 0) (void)out.add(box);
  }
  return out;
}

/// Whether the guard stops anywhere on these setpoints.
bool is_stopped_by_a_box(const std::vector<CycleRecord>& records, const MachineModel& model) {
  const double period_s = static_cast<double>(model.cycle_ns) * 1e-9;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const Setpoint& now = records[i].setpoint;
    const GuardVerdict verdict =
        check(model, now.position, now.velocity, records[i - 1].setpoint.position, period_s);
    if (verdict.alarm == Alarm::kKeepOut) return true;
  }
  return false;
}

/// How near the setpoints come to a box: the largest depth, negative outside.
double nearest(const std::vector<CycleRecord>& records, const KeepOut& keep_out) {
  double depth = -1e9;
  for (const CycleRecord& record : records) {
    for (const KeepOutBox& box : keep_out.boxes()) {
      depth = std::max(depth, depth_inside(box, record.joints));
    }
  }
  return depth;
}

TEST(DrawnKeepOut, IsSeenByPreflightPlannerAndGuardAlike) {
  const int programs = test::number_of("MERIDIAN_SETUP_LIMITS", 24);
  constexpr unsigned kSeed = 20261128;
  constexpr double kNear = 5e-3;  // mm, rad: what a box's face is bent by between samples
  std::mt19937_64 engine(kSeed);
  const MachineModel own =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  int run = 0, refused_first = 0, refused_between = 0;
  for (int n = 0; n < programs; ++n) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", program " << n);
    const std::string text = test::drawn_program(engine);
    MachineModel model = own;
    model.keep_out = drawn_keep_out(own, engine);
    const test::TextFile part(text);
    const auto preflight =
        stream::preflight(part.path(), {}, stream::PreflightMachine{model, ToolTable(), ""});
    const test::SimulatedRun boxed = test::run_simulation(text, model);
    const test::SimulatedRun whole = test::run_simulation(text, own);
    ASSERT_EQ(whole.report.outcome, simulate::Outcome::kDone) << whole.report.reason;
    ASSERT_NE(boxed.report.outcome, simulate::Outcome::kFault)
        << "the guard fired: " << boxed.report.reason;
    const bool is_done = boxed.report.outcome == simulate::Outcome::kDone;
    if (preflight.is_refused) {
      ASSERT_FALSE(is_done) << "preflight refused what runs";
    }
    if (!is_done) {
      ASSERT_EQ(boxed.report.outcome, simulate::Outcome::kRefused);
      EXPECT_TRUE(is_stopped_by_a_box(whole.records, model) ||
                  nearest(whole.records, model.keep_out) > -kNear)
          << boxed.report.reason;
    } else {
      EXPECT_FALSE(is_stopped_by_a_box(boxed.records, model));
      EXPECT_LE(nearest(boxed.records, model.keep_out), kKeepOutRounding);
    }
    run += is_done ? 1 : 0;
    refused_first += preflight.is_refused ? 1 : 0;
    refused_between += !is_done && !preflight.is_refused ? 1 : 0;
  }
  std::printf("%d of %d programs run, %d refused by preflight, %d on the way between blocks\n", run,
              programs, refused_first, refused_between);
  EXPECT_GT(run, programs / 10);
  EXPECT_GT(refused_first, programs / 20);
  EXPECT_GT(refused_between, programs / 10);
}

}  // namespace
}  // namespace meridian
