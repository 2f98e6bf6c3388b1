// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/stop_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "unit/cycle/cutting.hpp"

namespace meridian::test::stop_motion {
namespace {

TEST(StopMotion, AStopIsOverWhenItsLawAndItsDeviationAre) {
  CycleState state;
  EXPECT_TRUE(is_stop_over(state.stop)) << "none was begun";
  lay_out_stop(state, {0, 40, 0, 0}, {1000, 30000});
  EXPECT_EQ(state.stop.mode, StopMode::kOnPath);
  EXPECT_EQ(state.stop.speed_begin, 40);
  const StopLaw law({0, 40, 0, 0}, {1000, 30000});
  EXPECT_EQ(state.stop.stopping_time, law.duration());
  EXPECT_EQ(state.stop.stopping_distance, law.distance());
  state.stop.time = law.duration() - 1e-6;
  EXPECT_FALSE(is_stop_over(state.stop));
  state.stop.time = law.duration();
  EXPECT_TRUE(is_stop_over(state.stop));
  state.stop.deviation_time = law.duration() + 0.1;
  EXPECT_FALSE(is_stop_over(state.stop));
  state.stop.change(StopEvent::kHold);
  state.stop.time = 10;
  EXPECT_FALSE(is_stop_over(state.stop)) << "along the plan the plan's rest ends it";
}

TEST(StopMotion, AHoldWithoutAuthorityGoesAlongThePlanUntilItsRateIsZero) {
  Cutting one(0);
  one.world.command(Verb::kHold);
  EXPECT_EQ(one.world.state.stop.mode, StopMode::kHoldAlongPlan);
  double before = 1;
  for (int n = 0; n < 20; ++n) {
    const double rate = one.world.run().rate;
    EXPECT_LT(rate, before);
    before = rate;
  }
  EXPECT_EQ(one.world.now(), State::kHolding) << "no stop at once";
  ASSERT_TRUE(one.world.run_until(State::kHeld, 3));
  EXPECT_EQ(one.world.state.velocity, JointVector{});
  EXPECT_EQ(one.world.count(EventCode::kStopped), 1);
}

TEST(StopMotion, AStopThatComesToMoreMarginEndsSooner) {
  Holding one, harder;
  harder.grant();
  const double time = harder.stop().stopping_time, distance = harder.stop().stopping_distance;
  ASSERT_TRUE(harder.follow_one_cycle() && one.follow_one_cycle());
  const double gained = time - harder.stop().stopping_time;
  EXPECT_EQ(one.stop().stopping_time, time);
  EXPECT_GT(gained, 0.1);
  const double begun_at = 0.03, begun_s = one.stop().law.at(begun_at).s - one.stop().law.at(0).s;
  EXPECT_NEAR(harder.stop().stopping_time, begun_at + harder.stop().law.duration(), 1e-9);
  EXPECT_NEAR(harder.stop().stopping_distance, begun_s + harder.stop().law.distance(), 1e-9);
  EXPECT_LT(harder.stop().stopping_distance, distance);
  EXPECT_NEAR(harder.stop().rate_begin, harder.stop().speed_begin / 100, 1e-9)
      << "the rate of plan time goes on from where it was";
  while (!is_stop_over(harder.stop())) ASSERT_TRUE(harder.follow_one_cycle());
  EXPECT_EQ(harder.world.state.on_path.ds, 0);
}

TEST(StopMotion, AStopBesideThePathKeepsItsLawUntilItIsBackOnIt) {
  Holding beside;
  beside.grant();
  const double time = beside.stop().stopping_time;
  beside.stop().deviation_time = beside.stop().time + 0.0025;
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(beside.follow_one_cycle());
    EXPECT_EQ(beside.stop().stopping_time, time);
  }
  ASSERT_TRUE(beside.follow_one_cycle());
  EXPECT_LT(beside.stop().stopping_time, time);
  EXPECT_EQ(beside.stop().deviation_time, 0);
}

TEST(StopMotion, AStopThatBeginsBesideThePathComesBackToIt) {
  Cutting one, beside;
  for (Cutting* it : {&one, &beside}) {
    Cycle c = it->cycle();
    begin_stop(c, StopKind::kHold);
    ASSERT_EQ(it->world.state.stop.mode, StopMode::kOnPath);
    if (it == &beside) {
      it->world.state.stop.deviation[1] = 0.5;
      it->world.state.stop.deviation_time = 0.02;
    }
    ASSERT_TRUE(follow_stop(c));
  }
  const CycleState &on = one.world.state, &off = beside.world.state;
  EXPECT_EQ(off.joints[0], on.joints[0]);
  EXPECT_GT(off.joints[1] - on.joints[1], 0.3) << "most of it is left";
  EXPECT_LT(off.joints[1] - on.joints[1], 0.5);
  while (!is_stop_over(off.stop)) {
    Cycle c = beside.cycle(), d = one.cycle();
    ASSERT_TRUE(follow_stop(c) && follow_stop(d));
  }
  EXPECT_EQ(off.joints, on.joints) << "nothing is left";
}

TEST(StopMotion, AHoldEndsInTheTailOfItsWindowOnlyWhereTheProgramCanGoOnFromThere) {
  Cutting open, behind(1, 4);
  for (const State state : {State::kHolding, State::kAborting, State::kFaultStop}) {
    open.world.state.state = behind.world.state.state = state;
    EXPECT_TRUE(may_keep_tail(open.cycle())) << "the planner remembers its window";
    EXPECT_EQ(may_keep_tail(behind.cycle()), state != State::kHolding)
        << "three windows later it does not: of a program that is void it need not";
  }
  behind.world.state.state = State::kHolding;
  behind.world.state.rate = RateFilter({0.1, 1});  // rests in 5 s of plan time
  behind.world.state.rate.reset(1);
  EXPECT_TRUE(may_keep_tail(behind.cycle())) << "nothing else would end the hold";
}

TEST(StopMotion, AFaultStopLeavesThePlanOnlyForALawThatSlowsDownSoAnyway) {
  Cutting one;  // at 100 mm/s, with authority for 3000 mm/s² and 120 000 mm/s³
  const StopMargin authority{3000, 120'000};
  const auto is_reckoned_at = [&](double ds, double dds) {
    one.world.state.on_path.ds = ds;
    one.world.state.on_path.dds = dds;
    return is_reckoned_with(one.cycle(), authority);
  };
  EXPECT_TRUE(is_reckoned_at(100, 0));
  EXPECT_TRUE(is_reckoned_at(80, 400)) << "where it gains speed";
  EXPECT_TRUE(is_reckoned_at(80, -2000)) << "the law would come down from 96.7 mm/s like that";
  EXPECT_FALSE(is_reckoned_at(85, -2000)) << "from more than the plan has";
  EXPECT_FALSE(is_reckoned_at(50, -3100)) << "harder than the law ever is";
}

/// What a law has further up is not what it has here where its margin changes with the speed.
TEST(StopMotion, AFaultStopLeavesThePlanOnlyWhereTheMarginIsTheOneOfTheSpeedItComesDownFrom) {
  struct Case {
    double velocity;  // up to which 3000 and 120 000 are granted; 0: up to any
    double rest_accel, rest_jerk;
    bool is_reckoned;
  };
  for (const Case& c :
       {Case{0, 0, 0, true}, {200, 3000, 900'000, false}, {200, 9000, 120'000, false}}) {
    Cutting one;
    auto& piece = const_cast<TimePiece&>(*one.world.reader.piece());
    piece.authority_velocity = c.velocity;
    piece.rest_fault_accel = c.rest_accel;
    piece.rest_fault_jerk = c.rest_jerk;
    PathState& here = one.world.state.on_path;
    here.ds = 60;
    here.dds = -2000;
    const StopMargin authority = authority_of(piece, StopKind::kFault, here);
    EXPECT_EQ(is_reckoned_with(one.cycle(), authority), c.is_reckoned)
        << c.rest_accel << " " << c.rest_jerk;
  }
}

TEST(StopMotion, AFaultStopLeavesASmoothPlanThatIsSlowForWhatLiesBetweenRestAndItsSlowMargin) {
  Cutting one;
  auto& piece = const_cast<TimePiece&>(*one.world.reader.piece());
  piece.slow_velocity = 40;
  piece.slow_fault_accel = 3000;
  piece.slow_fault_jerk = 120'000;
  piece.rest_fault_accel = 9000;
  piece.rest_fault_jerk = 900'000;
  one.world.state.stop.mode = StopMode::kFaultAlongPlan;
  one.world.state.on_path.ds = 2;
  one.world.state.on_path.dds = -100;
  EXPECT_GT(authority_to_leave_plan(one.cycle()).jerk, 200'000);
  one.world.state.on_path.dds = -3100;
  EXPECT_EQ(authority_to_leave_plan(one.cycle()).jerk, 0) << "harder than the margin lets it be";
}

}  // namespace
}  // namespace meridian::test::stop_motion
