// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/monitoring/set_up_jog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "service/daemon/monitoring/cycle_monitor.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/monitoring_file.hpp"
#include "service/recording/record/words.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/shipped_machines.hpp"
#include "unit/cycle/hand.hpp"

namespace meridian::interpolator {
namespace {

constexpr double kSetUpSpeed = 2000.0 / 60;  // mm/s

/// A hand on a machine whose guard is open, and the monitoring beside it.
struct WatchedHand {
  WatchedHand(const MachineModel& machine, const monitoring::Limits& allowed, const JointVector& at)
      : limits(allowed), hand(machine, at), monitor(allowed, 0.1) {
    hand.world.in.tool_length_mm = machine.tool_length_mm;
    cycle();
  }

  /// As the service does it.
  void cycle() {
    CycleInputs& in = hand.world.in;
    in.feedback.is_guard_open = is_guard_open;
    in.feedback.arrival_ns = in.now_ns;
    in.feedback.joint_arrival_ns.fill(in.now_ns);
    in.feedback.joint_cycle_seen.fill(in.feedback.cycle_seen);
    const bool is_slowed = is_guard_open && is_jog_slowed;
    in.max_jog_speed = is_slowed ? set_up_jog_speed(hand.world.machine, limits, hand.world.state,
                                                    in.tool_length_mm)
                                 : std::numeric_limits<double>::infinity();
    const MonitoringAlarm next =
        monitor.check(hand.world.machine, in, hand.world.out.record, false, 0);
    if (found.alarm == Alarm::kNone) found = next;
    hand.world.run();
  }
  void wait(double seconds) {
    for (double t = 0; t < seconds; t += hand.world.dt()) cycle();
  }
  void hold(int joint, double velocity, double seconds) {
    for (double t = 0; t < seconds; t += 0.02) {
      hand.order(joint, velocity);
      wait(0.02);
    }
  }
  /// Share of its limit that joint `i` goes at.
  [[nodiscard]] double share(std::size_t i) const {
    return std::abs(hand.world.state.velocity[i]) / limits.axes[i].set_up_speed;
  }

  monitoring::Limits limits;
  test::Hand hand;
  CycleMonitor monitor;
  MonitoringAlarm found;
  bool is_guard_open = true, is_jog_slowed = true;
};

[[nodiscard]] monitoring::Limits limits_of(const std::string& name, const MachineModel& model) {
  return config::load_monitoring(test::shipped_file(name), model);
}

/// The Lai machine, its tool `tilt` beside the pole.
struct BesideThePole {
  explicit BesideThePole(double tilt)
      : model(config::load_machine(test::shipped_file("lai"))), limits(limits_of("lai", model)) {
    at[4] = tilt;
  }
  MachineModel model;
  monitoring::Limits limits;
  JointVector at{};
};

constexpr int kAcross = kMaxJoints + static_cast<int>(ToolAxis::kTiltY);
constexpr int kAlongX = kMaxJoints + static_cast<int>(ToolAxis::kX);

TEST(SetUpJog, SlowsAJointDownToTheTipsSpeed) {
  const BesideThePole pole(0.2);
  WatchedHand watched(pole.model, pole.limits, pole.at);
  ASSERT_TRUE(watched.hand.lay_on(0));
  watched.hold(0, 300, 0.6);
  EXPECT_NEAR(watched.hand.world.state.velocity[0], 0.9 * kSetUpSpeed, 1e-6);
  EXPECT_EQ(watched.found.alarm, Alarm::kNone);
  watched.hold(0, 5, 0.6);
  EXPECT_NEAR(watched.hand.world.state.velocity[0], 5, 1e-9) << "who is slower stays so";
}

TEST(SetUpJog, IsWhatTheMonitoringWouldElseFind) {
  const BesideThePole pole(0.2);
  WatchedHand watched(pole.model, pole.limits, pole.at);
  watched.is_jog_slowed = false;
  ASSERT_TRUE(watched.hand.lay_on(0));
  watched.hold(0, 300, 0.6);
  EXPECT_EQ(watched.found.alarm, Alarm::kTipSpeed);
}

TEST(SetUpJog, LetsTheTableTurnNoFasterThanInSetUpBesideThePole) {
  for (const double tilt : {0.002, 0.02, 0.2}) {
    for (const int axis : {kAcross, kAcross - 1, kAlongX}) {
      for (const double direction : {-1.0, 1.0}) {
        SCOPED_TRACE(testing::Message() << tilt << " rad, " << axis << ", " << direction);
        const BesideThePole pole(tilt);
        WatchedHand watched(pole.model, pole.limits, pole.at);
        ASSERT_TRUE(watched.hand.lay_on(axis));
        watched.hold(axis, direction * (axis == kAlongX ? 300 : 2), 1.5);
        EXPECT_EQ(watched.found.alarm, Alarm::kNone)
            << record::word(watched.found.alarm) << " of " << watched.found.joint;
        EXPECT_LE(watched.share(3), 1);
      }
    }
  }
}

TEST(SetUpJog, SlowsDownAHandThatMovedWhenTheGuardOpened) {
  const BesideThePole pole(0.2);
  WatchedHand watched(pole.model, pole.limits, pole.at);
  watched.is_guard_open = false;
  watched.wait(0.01);
  ASSERT_TRUE(watched.hand.lay_on(0));
  watched.hold(0, 200, 0.4);
  ASSERT_GT(watched.hand.world.state.velocity[0], 100);
  watched.is_guard_open = true;
  watched.hold(0, 200, 0.5);
  EXPECT_NEAR(watched.hand.world.state.velocity[0], 0.9 * kSetUpSpeed, 1e-6);
  watched.hold(0, -200, 2.5);
  EXPECT_EQ(watched.found.alarm, Alarm::kNone) << "also once its time to stop is over";
}

TEST(SetUpJog, NeverTripsTheMonitoringOnAnyShippedMachine) {
  std::mt19937 random(20261128);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  int moved = 0, holds = 0;
  for (const std::string& name : test::shipped_machines()) {
    const MachineModel model = config::load_machine(test::shipped_file(name));
    const monitoring::Limits limits = limits_of(name, model);
    for (int n = 0; n < test::draws(3) * (kToolAxisCount + model.joint_count); ++n) {
      const int index = n % (kToolAxisCount + model.joint_count);
      const int axis = index < model.joint_count ? index : kMaxJoints + index - model.joint_count;
      JointVector at{};
      for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
        const JointSpec& joint = model.joints[i];
        const double span = joint.is_rotary ? (n % 2 == 0 ? 0.01 : 0.3) : 50;
        at[i] = std::clamp(joint.home + uniform(-span, span), joint.limits.travel_min,
                           joint.limits.travel_max);
      }
      WatchedHand watched(model, limits, at);
      if (!watched.hand.lay_on(axis)) continue;
      const JointVector begin = watched.hand.world.state.joints;
      for (int k = 0; k < 3; ++k) watched.hold(axis, uniform(-1, 1) * 500, uniform(0.05, 0.7));
      const bool has_moved = watched.hand.world.state.joints != begin;
      moved += has_moved ? 1 : 0;
      ++holds;
      ASSERT_EQ(watched.found.alarm, Alarm::kNone)
          << name << ", axis " << axis << ", hold " << n << ": "
          << record::word(watched.found.alarm) << " of " << watched.found.joint << ", "
          << watched.found.value;
    }
  }
  EXPECT_GT(moved, holds * 3 / 4);
}

/// docs/monitoring.md has these figures: of the Lai machine, a linear joint at 0.9 of 2 m/min.
TEST(SetUpJog, ComesToRestSoonAfterTheLastOrder) {
  const BesideThePole pole(0.2);
  WatchedHand watched(pole.model, pole.limits, pole.at);
  ASSERT_TRUE(watched.hand.lay_on(0));
  watched.hold(0, 300, 0.6);
  watched.hand.order(0, 300);
  watched.hand.world.in.jog.dead_man_s = 0.15;
  watched.cycle();
  const CycleState& state = watched.hand.world.state;
  const double begin = state.joints[0];
  int cycles = 0;
  for (; state.velocity[0] != 0 && cycles < 1000; ++cycles) watched.cycle();
  const double time_s = cycles * watched.hand.world.dt(), distance_mm = state.joints[0] - begin;
  RecordProperty("rest_ms", static_cast<int>(std::lround(1e3 * time_s)));
  RecordProperty("rest_um", static_cast<int>(std::lround(1e3 * distance_mm)));
  EXPECT_LE(time_s, 0.25) << distance_mm << " mm";
  EXPECT_LE(distance_mm, 7);
  EXPECT_EQ(watched.found.alarm, Alarm::kNone);
}

TEST(SetUpJog, TakesAnotherToolForNoMotionOfTheTip) {
  const BesideThePole pole(0.2);
  WatchedHand watched(pole.model, pole.limits, pole.at);
  ASSERT_TRUE(watched.hand.lay_on(0));
  watched.hold(0, 20, 0.3);
  watched.hand.world.in.tool_length_mm += 80;
  watched.hold(0, 20, 0.3);
  EXPECT_EQ(watched.found.alarm, Alarm::kNone);
  watched.is_jog_slowed = false;
  watched.hold(0, 60, 0.4);
  EXPECT_EQ(watched.found.alarm, Alarm::kTipSpeed) << "it is watched with the new one";
}

}  // namespace
}  // namespace meridian::interpolator
