// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/cycle/cutting.hpp"

/// Stops without a margin of their own: they go along the plan, whose rate goes down to zero.
namespace meridian::test::stop_along_plan {
namespace {

TEST(StopAlongPlan, GoesOnAlongThePathByTheSpeedThatItHas) {
  Cutting one(0);
  one.world.command(Verb::kHold);
  const CycleState& state = one.world.state;
  ASSERT_EQ(state.stop.mode, StopMode::kHoldAlongPlan);
  const double dt = one.world.dt(), begin = state.on_path.s;
  for (int n = 0; n < 200; ++n) {
    const PathState before = state.on_path;
    one.world.run();
    const double travelled = 0.5 * (before.ds + state.on_path.ds) * dt;
    EXPECT_NEAR(state.on_path.s - before.s, travelled, 1e-3 * travelled) << n;
    EXPECT_LT(state.on_path.ds, before.ds) << n;
  }
  EXPECT_GT(state.on_path.s, begin + 10);
}

/// Held, without a margin, `ahead` s of plan time before the tail of the window in force. The
/// window that goes on in its place is there.
struct HeldBeforeTail : Program {
  explicit HeldBeforeTail(double ahead) {
    plan.stop_share = 0;
    plan.cut_with_tail({200, 0, 0}, kLimits, 1);
    plan.continue_cut();
    plan.barrier(TimeKind::kEnd);
    run(0.3);
    const TimePiece& cruise = *world.reader.piece();
    EXPECT_EQ(cruise.duration, 1);
    while (cruise.duration - world.state.piece_time > ahead) world.run();
    world.command(Verb::kHold);
    EXPECT_EQ(world.state.stop.mode, StopMode::kHoldAlongPlan);
  }
  [[nodiscard]] bool ends_in_tail() {
    bool is_on_tail = false;
    while (world.now() == State::kHolding) {
      world.run();
      is_on_tail = is_on_tail || (world.reader.piece() != nullptr && world.reader.piece()->is_tail);
    }
    return is_on_tail;
  }
};

/// The rate needs about a second to rest. In 0.3 s of it 0.27 s of plan time pass.
TEST(StopAlongPlan, EndsInTheTailOfItsWindowWhereItComesToItLateOnly) {
  EXPECT_FALSE(HeldBeforeTail(0.2).ends_in_tail()) << "the next window goes on";
  EXPECT_TRUE(HeldBeforeTail(0.35).ends_in_tail()) << "the tail is sooner at rest than the rate";
}

}  // namespace
}  // namespace meridian::test::stop_along_plan
