// SPDX-License-Identifier: Apache-2.0

/// Single block: what is reported at a block's end, and ends that come right after a rest.

#include <gtest/gtest.h>

#include <cstddef>

#include "unit/cycle/program.hpp"

namespace meridian::test::step_block_ends {
namespace {

constexpr double kLong_s = 10;

/// A cut of 80 mm along x; its block ends at `end_mm` of it.
struct EndsAt : Program {
  explicit EndsAt(double end_mm) {
    plan.block_end_s = end_mm;
    plan.cut({80, 0, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    for (std::size_t i = 0; const TimePiece* piece = world.port->times.peek(i); ++i) {
      if (piece->kind == TimeKind::kMove) planned_s += piece->duration;
    }
    world.command(Verb::kSingleBlock, 1);
    run(0);
  }
  [[nodiscard]] double tip_x() const {
    return forward(machine, machine.tool_length_mm, world.records.back().joints).tip.x();
  }

  double planned_s = 0;  ///< of the whole cut
};

TEST(StepBlockEnds, ThatComeRightAfterARestAreNotPassed) {
  for (const double end_mm : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    EndsAt p(end_mm);
    ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s)) << end_mm;
    EXPECT_NEAR(p.tip_x(), end_mm, 1e-9);
    p.world.command(Verb::kResume);
    ASSERT_TRUE(p.world.run_until(State::kReady, kLong_s));
    EXPECT_NEAR(p.tip_x(), 80, 1e-9) << "the rest of the plan";
  }
}

TEST(StepBlockEnds, InMidMotionReportTheBlockAndItsLine) {
  EndsAt p(30);
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  ASSERT_EQ(p.world.count(EventCode::kBlockDone), 1);
  EXPECT_EQ(p.world.last(EventCode::kBlockDone).a, 0U);
  EXPECT_EQ(p.world.last(EventCode::kBlockDone).b, 10U) << "its line";
  EXPECT_EQ(p.world.state.line, 10U);
}

TEST(StepBlockEnds, StandStillInPlanTimeToo) {
  EndsAt middle(40), whole(80);  // half of the length is half of the time
  ASSERT_TRUE(middle.world.run_until(State::kStepping, kLong_s));
  ASSERT_TRUE(whole.world.run_until(State::kStepping, kLong_s));
  EXPECT_NEAR(middle.world.records.back().plan_time_s, 0.5 * middle.planned_s, 1e-9);
  EXPECT_NEAR(whole.world.records.back().plan_time_s, whole.planned_s, 1e-9);
  whole.world.run_for(0.1);
  EXPECT_NEAR(whole.world.records.back().plan_time_s, whole.planned_s, 1e-9);
}

}  // namespace
}  // namespace meridian::test::step_block_ends
