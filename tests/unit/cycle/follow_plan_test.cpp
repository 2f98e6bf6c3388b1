// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/follow_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/cycle/program.hpp"

/// The program's motion in plan time, and the rests of it.
namespace meridian {
namespace {

using test::alarm_of;
using test::kLimits;
using test::Program;

/// The largest speed along the path in the next `seconds`.
double top_speed(Program& p, double seconds) {
  double top = 0;
  for (double t = 0; t < seconds; t += p.world.dt()) {
    p.world.run();
    top = std::max(top, p.world.state.on_path.ds);
  }
  return top;
}

/// The top speed of a motion of 100 mm/s with a feed and a rapid override.
double speed_with(MotionKind motion, double feed, double rapid, double factor = 1) {
  MachineModel model = test::lai_machine();
  model.max_feed_override = 2;
  Program p(State::kReady, model);
  p.plan.set_feed_factor(factor);
  p.plan.cut({60, 0, 0}, kLimits, motion);
  p.plan.barrier(TimeKind::kEnd);
  p.world.command(Verb::kFeedOverride, feed);
  p.world.command(Verb::kRapidOverride, rapid);
  p.run(0);
  return top_speed(p, 4);
}

TEST(FollowPlan, RunsCutsAtTheFeedOverrideAndRapidsAtTheirs) {
  const double cut = speed_with(MotionKind::kCut, 1, 1);
  EXPECT_NEAR(cut, 100, 1);
  EXPECT_NEAR(speed_with(MotionKind::kCut, 0.6, 0.3), 0.6 * cut, 1e-6);
  EXPECT_NEAR(speed_with(MotionKind::kRapid, 0.6, 0.3), 0.3 * cut, 1e-6);
  EXPECT_NEAR(speed_with(MotionKind::kApproach, 0.6, 0.3), 0.3 * cut, 1e-6);
  EXPECT_NEAR(speed_with(MotionKind::kRewind, 0.6, 0.3), 0.3 * cut, 1e-6) << "the slower one";
  EXPECT_NEAR(speed_with(MotionKind::kRewind, 0.4, 0.7), 0.4 * cut, 1e-6);
}

TEST(FollowPlan, RunsWhatWasPlannedFasterAtTheOverrideOverThatFactor) {
  const double planned = speed_with(MotionKind::kCut, 1, 1);
  EXPECT_NEAR(speed_with(MotionKind::kCut, 1.5, 1, 1.5), planned, 1e-6);
  EXPECT_NEAR(speed_with(MotionKind::kCut, 1.2, 1, 1.5), 0.8 * planned, 1e-6);
  EXPECT_NEAR(speed_with(MotionKind::kCut, 1.5, 1, 1), planned, 1e-6) << "never above the plan";
  EXPECT_NEAR(speed_with(MotionKind::kRapid, 1.2, 1, 1.5), planned, 1e-6);
}

TEST(FollowPlan, AnOverrideIsInForceAtOnceWhereThePlanRests) {
  Program p;
  p.plan.cut({60, 0, 0}, kLimits, MotionKind::kRapid);
  p.plan.cut({-60, 0, 0}, kLimits);
  p.plan.cut({60, 0, 0}, kLimits, MotionKind::kRapid);
  p.plan.barrier(TimeKind::kEnd);
  p.world.command(Verb::kFeedOverride, 0.25);
  p.run(0);
  double plan_time = 0;  // of each motion alike
  int cycles[3] = {};
  while (p.world.now() != State::kReady) {
    p.world.run();
    const PathPiece* path = p.world.reader.path();
    if (p.world.reader.piece() != nullptr && path != nullptr) ++cycles[path->index];
    plan_time += p.world.dt();
    ASSERT_LT(plan_time, 20);
  }
  EXPECT_NEAR(cycles[1], 4 * cycles[0], 12) << "at a quarter, from its first cycle to its last";
  EXPECT_NEAR(cycles[2], cycles[0], 3);
}

TEST(FollowPlan, NoTimeIsLostWhereOneMotionFollowsAnother) {
  const auto cycles_of = [](int cuts) {
    Program p;
    for (int n = 0; n < cuts; ++n) p.plan.cut({n % 2 == 0 ? 5.0 : -5.0, 0, 0}, kLimits);
    p.plan.barrier(TimeKind::kEnd);
    p.run(0);
    int cycles = 0;
    for (; p.world.now() != State::kReady && cycles < 20000; ++cycles) p.world.run();
    return cycles;
  };
  const int one = cycles_of(1);
  EXPECT_NEAR(cycles_of(20), 20 * one, 22);
}

TEST(FollowPlan, TheStateOnThePathIsThatOfThePlanAtItsRate) {
  Program p;
  p.plan.cut({80, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0.03);
  p.world.command(Verb::kFeedOverride, 0.3);
  bool has_slope = false, is_bent = false;
  for (int n = 0; n < 400; ++n) {
    const double before = p.world.state.on_path.s;
    p.world.run();
    const CycleState& state = p.world.state;
    const PathState plan = state_at(*p.world.reader.piece(), state.piece_time);
    const double w = state.rate.rate(), slope = state.rate.slope();
    EXPECT_DOUBLE_EQ(state.on_path.s, plan.s);
    EXPECT_DOUBLE_EQ(state.on_path.ds, plan.ds * w);
    EXPECT_NEAR(state.on_path.dds, plan.dds * w * w + plan.ds * slope, 1e-9);
    EXPECT_NEAR(state.on_path.s - before, state.on_path.ds * p.world.dt(), 0.01);
    has_slope = has_slope || slope < -0.1;
    is_bent = is_bent || (plan.dds > 100 && w < 0.98);
  }
  EXPECT_TRUE(is_bent);
  EXPECT_TRUE(has_slope);
}

TEST(FollowPlan, ATailIsStarvingAndItsEndIsStarved) {
  Program p;
  p.plan.cut_with_tail({80, 0, 0}, kLimits, 0.1);
  p.run(0);
  ASSERT_TRUE(p.world.run_until(State::kStarving, 2));
  EXPECT_GT(p.world.state.on_path.ds, 90) << "from cruising speed";
  EXPECT_EQ(p.world.state.starvations, 0);
  ASSERT_TRUE(p.world.run_until(State::kStarved, 2));
  EXPECT_EQ(p.world.state.starvations, 1);
  EXPECT_EQ(p.world.state.on_path.ds, 0);
  EXPECT_EQ(p.world.state.velocity, JointVector{});
}

TEST(FollowPlan, ATailIsSkippedWhereTheNextWindowIsThere) {
  Program p;
  p.plan.cut_with_tail({80, 0, 0}, kLimits, 0.1);
  p.plan.continue_cut();
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  while (p.world.now() != State::kReady) {
    p.world.run();
    ASSERT_NE(p.world.now(), State::kStarving);
    ASSERT_NE(p.world.now(), State::kStarved);
  }
  EXPECT_EQ(p.world.state.starvations, 0);
}

TEST(FollowPlan, GoesOnByItselfWhereBlocksComeSoonAndFromTheSameSession) {
  struct Case {
    double wait_s;
    bool is_other_session, goes_on;
  };
  MachineModel model = test::lai_machine();
  model.starve_auto_resume_s = 1;
  for (const Case& c : {Case{0.5, false, true}, {1.5, false, false}, {0.5, true, false}}) {
    Program p(State::kReady, model);
    p.plan.cut({20, 0, 0}, kLimits);
    p.run(0);
    ASSERT_TRUE(p.world.run_until(State::kStarved, 2));
    p.world.run_for(c.wait_s);
    if (c.is_other_session) ++p.world.in.session;
    p.plan.cut({-20, 0, 0}, kLimits);
    p.world.run_for(0.1);
    EXPECT_EQ(p.world.now(), c.goes_on ? State::kRunning : State::kStarved) << c.wait_s;
    EXPECT_EQ(p.world.state.on_path.ds > 0, c.goes_on);
  }
}

TEST(FollowPlan, DwellsToTheCycle) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kDwell, 0.25);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  int cycles = 0;
  for (int n = 0; n < 3000; ++n) {
    p.world.run();
    const TimePiece* piece = p.world.reader.piece();
    cycles += piece != nullptr && piece->kind == TimeKind::kDwell;
  }
  EXPECT_NEAR(cycles, std::round(0.25 / p.world.dt()), 1);
}

TEST(FollowPlan, AnActionThatIsNotDoneInTimeHoldsTheProgramAndIsAskedForAgain) {
  Program p;
  p.world.state.options.action_timeout_s = 0.5;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kAction);
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  while (p.world.count(EventCode::kActionDue) == 0) p.world.run();
  p.world.run_for(0.49);
  EXPECT_EQ(p.world.now(), State::kRunning);
  p.world.run_for(0.03);
  EXPECT_EQ(p.world.now(), State::kHeld);
  EXPECT_EQ(alarm_of(p.world), Alarm::kActionFailed);
  EXPECT_NEAR(p.world.last(EventCode::kAlarm).x, 0.5, 0.01) << "how long it was waited for";
  p.world.command(Verb::kResume);
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 2);
  p.world.in.action = {1, true, false};
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kHeld) << "refused";
  p.world.command(Verb::kResume);
  p.world.run_for(0.1);
  p.world.in.action = {1, true, true};
  ASSERT_TRUE(p.world.run_until(State::kReady, 3));
}

TEST(FollowPlan, AStopWaitsForAResumeAndAnOptionalOneWhereItIsAskedFor) {
  for (const bool is_asked_for : {false, true}) {
    for (const TimeKind kind : {TimeKind::kStop, TimeKind::kOptionalStop}) {
      Program p;
      p.world.command(Verb::kOptionalStop, is_asked_for ? 1 : 0);
      p.plan.cut({5, 0, 0}, kLimits);
      p.plan.barrier(kind);
      p.plan.cut({5, 0, 0}, kLimits);
      p.plan.barrier(TimeKind::kEnd);
      p.run(2);
      const bool stops = kind == TimeKind::kStop || is_asked_for;
      EXPECT_EQ(p.world.now(), stops ? State::kHeld : State::kReady);
      EXPECT_EQ(p.world.count(EventCode::kActionDue), kind == TimeKind::kStop ? 1 : 0);
      if (stops) p.world.command(Verb::kResume);
      EXPECT_TRUE(p.world.run_until(State::kReady, 3));
    }
  }
}

TEST(FollowPlan, TheEndOfAProgramIsReportedBehindItsLastBlock) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  ASSERT_TRUE(p.world.run_until(State::kReady, 3));
  EXPECT_EQ(p.world.count(EventCode::kProgramEnd), 1);
  EXPECT_EQ(p.world.count(EventCode::kBlockDone), 1);
  EXPECT_EQ(p.world.last(EventCode::kProgramEnd).a, 1U);
  EXPECT_EQ(p.world.reader.piece(), nullptr);
  EXPECT_EQ(p.world.state.piece_time, 0);
}

}  // namespace
}  // namespace meridian
