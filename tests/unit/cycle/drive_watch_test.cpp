// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/drive_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "program.hpp"
#include "support/cycle_world.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

using test::CycleWorld;
using test::refusal_of;

/// A machine in Off, Disabling or Fault, whose drives somebody else may have.
struct Idle {
  explicit Idle(State state = State::kOff) {
    world.run();
    if (state == State::kOff) return;
    EXPECT_TRUE(world.enable());
    if (state == State::kDisabling) {
      keeps_enabled = true;
      world.command(Verb::kDisable);
    } else {
      world.in.feedback.emergency_stop = true;
      EXPECT_TRUE(world.run_until(State::kFault, 1));
      world.in.feedback.emergency_stop = false;
      world.in.feedback.enabled_mask = 0;
    }
    EXPECT_EQ(world.now(), state);
  }
  /// `seconds` in which `drive` moves at `velocity`.
  void run(double seconds, int drive = 0, double velocity = 0) {
    for (double t = 0; t < seconds; t += world.dt()) {
      world.in.feedback.position[static_cast<std::size_t>(drive)] += velocity * world.dt();
      if (keeps_enabled) world.in.feedback.enabled_mask = 1U << drive;
      world.run();
    }
  }
  [[nodiscard]] int alarms() const {
    int n = 0;
    for (const Event& event : world.events) {
      n += event.code == EventCode::kAlarm && static_cast<Alarm>(event.a) == Alarm::kDrivesAstray;
    }
    return n;
  }

  CycleWorld world{test::lai_machine()};
  bool keeps_enabled = false;
};

TEST(DriveWatch, ADriveThatIsEnabledInOffIsAnAlarmAndLeadsToFault) {
  Idle idle;
  idle.run(1);
  EXPECT_EQ(idle.world.now(), State::kOff);
  idle.keeps_enabled = true;
  idle.run(2 * kWatchWindow_s, 2);
  EXPECT_EQ(idle.world.now(), State::kFault);
  EXPECT_EQ(idle.world.state.alarm, Alarm::kDrivesAstray);
  EXPECT_EQ(idle.world.last(EventCode::kAlarm).b, 2U) << "its joint";
  idle.run(3, 2);
  EXPECT_EQ(idle.alarms(), 1) << "once";
  idle.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(idle.world), Refusal::kFaultPresent);
  idle.world.command(Verb::kReset);
  EXPECT_EQ(refusal_of(idle.world), Refusal::kDrivesAstray) << "while it lasts";
  EXPECT_EQ(idle.world.now(), State::kFault);
  idle.keeps_enabled = false;
  idle.world.in.feedback.enabled_mask = 0;
  idle.run(0.2);
  idle.world.command(Verb::kReset);
  EXPECT_EQ(idle.world.now(), State::kOff);
}

TEST(DriveWatch, ADriveThatMovesInOffIsAnAlarmWithTheWay) {
  for (const double velocity : {0.5, -0.5, 300.0}) {
    Idle idle;
    idle.run(1);
    idle.run(4 * kWatchWindow_s, 1, velocity);
    EXPECT_EQ(idle.world.now(), State::kFault) << velocity;
    EXPECT_EQ(idle.world.last(EventCode::kAlarm).b, 1U);
    EXPECT_NEAR(idle.world.last(EventCode::kAlarm).x, velocity * kWatchWindow_s,
                0.05 * std::abs(velocity) * kWatchWindow_s + 1e-9);
  }
}

TEST(DriveWatch, MotionIsMoreThanAHundredthOfAMillimetreInAWindow) {
  for (const double velocity : {0.17, 0.23}) {  // 0.0085 and 0.0115 mm in 0.05 s
    Idle idle;
    idle.run(1);
    idle.run(6 * kWatchWindow_s, 0, velocity);
    EXPECT_EQ(idle.world.now(), velocity > 0.2 ? State::kFault : State::kOff) << velocity;
  }
}

TEST(DriveWatch, AWindowFromBeforeTheMachineWasOnSaysNothing) {
  Idle idle;
  idle.run(1);
  const auto move_one_window = [&] {
    while (idle.world.state.watch.time > 0) idle.world.run();
    idle.run(kWatchWindow_s, 0, 0.5);
  };
  move_one_window();
  ASSERT_TRUE(idle.world.enable());
  idle.world.command(Verb::kDisable);
  ASSERT_TRUE(idle.world.run_until(State::kOff, 1));
  idle.run(kOffGrace_s);
  move_one_window();
  idle.run(4 * kWatchWindow_s);
  EXPECT_EQ(idle.alarms(), 0) << "two windows in a row, not two in all";
}

TEST(DriveWatch, BeginsItsFirstWindowBehindTheGrace) {
  const auto off_again = [](Idle& idle) {
    ASSERT_TRUE(idle.world.enable());
    idle.world.command(Verb::kDisable);
    ASSERT_TRUE(idle.world.run_until(State::kOff, 1));
  };
  const auto end_grace = [](Idle& idle) {
    while (idle.world.state.state_time + idle.world.dt() <= kOffGrace_s) idle.world.run();
  };
  Idle sagging;
  sagging.run(1);
  while (std::abs(sagging.world.state.watch.time - 0.4 * kWatchWindow_s) > sagging.world.dt()) {
    sagging.world.run();
  }
  off_again(sagging);
  sagging.run(0.3, 0, 3);
  end_grace(sagging);
  sagging.run(kWatchWindow_s, 0, 1);
  sagging.run(4 * kWatchWindow_s);
  EXPECT_EQ(sagging.alarms(), 0) << "a window that was open before counts neither its time nor sag";

  Idle moved;
  moved.run(1);
  while (moved.world.state.watch.time > 0) moved.world.run();
  moved.run(kWatchWindow_s, 0, 0.5);
  off_again(moved);
  end_grace(moved);
  moved.run(kWatchWindow_s, 0, 0.5);
  moved.run(4 * kWatchWindow_s);
  EXPECT_EQ(moved.alarms(), 0) << "nor does a window that was full";
}

TEST(DriveWatch, IsAnAlarmOfItsOwnInFaultAndInDisabling) {
  for (const State state : {State::kFault, State::kDisabling}) {
    Idle idle(state);
    idle.keeps_enabled = true;
    idle.run(kOffGrace_s - 0.02, 3);
    EXPECT_EQ(idle.world.now(), state) << "drives have so long to go off";
    EXPECT_EQ(idle.alarms(), 0);
    idle.run(3 * kWatchWindow_s, 3);
    EXPECT_EQ(idle.world.now(), State::kFault);
    EXPECT_EQ(idle.alarms(), 1);
    EXPECT_EQ(idle.world.last(EventCode::kAlarm).b, 3U);
  }
}

TEST(DriveWatch, ReportsTheNextTimeAgain) {
  Idle idle(State::kFault);
  idle.run(1);
  for (int n = 1; n <= 3; ++n) {
    idle.run(0.3, 0, 10);
    EXPECT_EQ(idle.alarms(), n);
    idle.run(0.3);
  }
}

TEST(DriveWatch, TakesNoNoiseSagJumpOrSilenceForMotion) {
  const auto stays_off = [](const char* what, const std::function<void(Idle&, int)>& change,
                            bool is_alive = true) {
    Idle idle;
    idle.run(1);
    idle.world.are_drives_alive = is_alive;
    for (int n = 0; n < 2000; ++n) {
      change(idle, n);
      idle.world.run();
    }
    EXPECT_EQ(idle.world.now(), State::kOff) << what;
  };
  const auto position = [](Idle& idle) -> double& { return idle.world.in.feedback.position[0]; };
  stays_off("noise of 2 um", [&](Idle& idle, int n) { position(idle) = n % 2 == 0 ? 0 : 0.002; });
  stays_off("one report that is off",
            [&](Idle& idle, int n) { position(idle) = n == 449 ? 50 : 0; });
  stays_off("drives started anew elsewhere", [&](Idle& idle, int n) {
    if (n == 500) position(idle) = 50;
  });
  stays_off("warming up, 0.05 mm/s", [&](Idle& idle, int) { position(idle) += 5e-5; });
  stays_off("enabled for one report",
            [](Idle& idle, int n) { idle.world.in.feedback.enabled_mask = n == 449 ? 1 : 0; });
  stays_off(
      "silent, and on when it was heard last",
      [](Idle& idle, int) { idle.world.in.feedback.enabled_mask = 1; }, false);
}

TEST(DriveWatch, SagOnTheBrakeAfterAFaultIsNoAlarm) {
  Idle idle(State::kFault);
  idle.run(0.3, 2, 1);
  idle.run(2);
  EXPECT_EQ(idle.alarms(), 0);
}

TEST(DriveWatch, AMachineWhoseDrivesObeyAnotherServiceIsNotEnabled) {
  Idle idle;
  idle.world.in.feedback.foreign_mask = 0b00010;
  idle.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(idle.world), Refusal::kDrivesTaken);
  EXPECT_EQ(idle.world.now(), State::kOff);
}

TEST(DriveWatch, DrivesThatObeyAnotherServiceWhileTheMachineIsOnEndInAFaultStop) {
  Idle idle;
  ASSERT_TRUE(idle.world.enable());
  idle.world.in.feedback.foreign_mask = 0b00010;
  idle.world.run();
  EXPECT_EQ(idle.world.states().at(3), State::kFaultStop);
  EXPECT_EQ(idle.world.state.alarm, Alarm::kDrivesAstray);
  EXPECT_EQ(idle.world.last(EventCode::kAlarm).b, 1U);
}

TEST(DriveWatch, ADryRunHasItsOwnAlarmForADriveThatIsOn) {
  Idle idle;
  idle.world.command(Verb::kDryRun, 1);
  idle.world.command(Verb::kEnable);
  ASSERT_TRUE(idle.world.run_until(State::kReady, 1));
  idle.world.in.feedback.enabled_mask = 1;
  idle.world.run();
  EXPECT_EQ(idle.world.state.alarm, Alarm::kDriveEnabled);
}

}  // namespace
}  // namespace meridian
