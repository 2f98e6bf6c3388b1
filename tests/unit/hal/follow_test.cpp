// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/component/follow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000, kBridge_ns = 3'000'000;
constexpr double kAmplitude = 20, kOmega = 10;  // mm, rad/s: 200 mm/s, 2000 mm/s²

[[nodiscard]] double position_at(double t) { return kAmplitude * std::sin(kOmega * t); }
[[nodiscard]] double speed(double t) { return kAmplitude * kOmega * std::cos(kOmega * t); }

class Follow : public testing::Test {
 protected:
  Follow() {
    setup_.joints = 1;
    setup_.period_ns = kPeriod_ns;
    setup_.bridge_ns = kBridge_ns;
    setup_.fault_acceleration[0] = 5000;
  }
  /// The process' period `n` ends at n * kPeriod_ns.
  void send(int n, bool is_on = true) {
    const double t = 1e-9 * static_cast<double>(n * kPeriod_ns);
    meridian_hal_setpoint one{};
    one.number = static_cast<std::uint64_t>(n);
    one.end_ns = n * kPeriod_ns;
    one.position[0] = position_at(t);
    one.velocity[0] = is_on ? speed(t) : 0;
    one.on_mask = is_on ? 1 : 0;
    meridian_hal_write(&shared_.setpoint_lock, &shared_.setpoints[n % MERIDIAN_HAL_KEPT], &one,
                       sizeof one);
  }
  void step(std::int64_t now_ns) {
    meridian_hal_step(&follow_, &shared_, &setup_, now_ns, thread_ns_, feedback_);
  }
  [[nodiscard]] double position() const { return follow_.position[0]; }
  /// Periods up to `last`, each sent in time, a step in each.
  void run_to(int last) {
    begin(2);
    for (int n = 3; n <= last; ++n) {
      send(n);
      step((n - 1) * kPeriod_ns);
    }
  }
  /// How far the farthest of the steps at these times leads an axis without lag.
  [[nodiscard]] double farthest_step(const std::vector<std::int64_t>& times) {
    double farthest = 0;
    for (const std::int64_t now_ns : times) {
      const double before = feedback_[0] = position();
      step(now_ns);
      farthest = std::max(farthest, std::abs(position() - before));
    }
    return farthest;
  }
  /// Off, then on from period `first` on; the servo thread where it is on.
  void begin(int first) {
    send(first - 1, false);
    step((first - 1) * kPeriod_ns);
    send(first);
    step(first * kPeriod_ns);
    step(first * kPeriod_ns + 1);
  }

  meridian_hal_shared shared_{};
  meridian_hal_setup setup_{};
  meridian_hal_follow follow_{};
  std::int64_t thread_ns_ = kPeriod_ns;  // of HAL's servo thread
  double feedback_[MERIDIAN_HAL_JOINTS] = {};
};

TEST_F(Follow, PositionsAreThoseOfOnePeriodAgoWhateverThePeriodsAre) {
  for (const std::int64_t servo_ns : {250'000, 700'000, 1'000'000, 1'300'000, 2'000'000}) {
    follow_ = {};
    shared_ = {};
    thread_ns_ = servo_ns;
    begin(2);
    std::mt19937 engine(11);
    std::uniform_int_distribution<std::int64_t> late(0, 900'000);
    int sent = 2;
    std::int64_t next_ns = 2 * kPeriod_ns + late(engine);  // the period that ends at 3 is written
    double before = 0;
    for (std::int64_t now = 2 * kPeriod_ns + servo_ns; now < 1500 * kPeriod_ns; now += servo_ns) {
      while (next_ns <= now) {
        send(++sent);
        next_ns = sent * kPeriod_ns + late(engine);
      }
      step(now);
      ASSERT_EQ(follow_.phase[0], MERIDIAN_HAL_FOLLOWS);
      const double wanted = position_at(1e-9 * static_cast<double>(now - kPeriod_ns));
      if (now < 8 * kPeriod_ns) {
        before = position();
        continue;
      }
      ASSERT_NEAR(position(), wanted, 1e-6) << servo_ns << " at " << now;
      ASSERT_LE(std::abs(position() - before), 1.001 * 200e-9 * static_cast<double>(servo_ns));
      before = position();
    }
  }
}

TEST_F(Follow, BeyondTheNewestSetpointItsVelocityLeadsFromItsPosition) {
  run_to(10);
  step(10 * kPeriod_ns + 500'000);
  for (int n = 11; n <= 60; ++n) {  // each comes when its time is over already
    step(n * kPeriod_ns + 900'000);
    EXPECT_NEAR(position(), position_at(1e-9 * static_cast<double>((n - 1) * kPeriod_ns + 900'000)),
                2e-3);
    send(n);
  }
}

TEST_F(Follow, LateSetpointsAreBridgedByTheVelocity) {
  run_to(10);
  double before = position();
  for (int n = 10; n <= 13; ++n) {  // nothing comes
    step(n * kPeriod_ns);
    EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_FOLLOWS);
    EXPECT_NEAR(position() - before, 0.2, 0.005) << "one period at 200 mm/s";
    before = position();
  }
  send(13);
  step(14 * kPeriod_ns);
  EXPECT_NEAR(position(), position_at(0.013), 1e-6);
}

TEST_F(Follow, SetpointsThatStayAwayRampDownAndStayOffUntilTheProcessSaysOff) {
  run_to(10);
  const double from = position();
  double before = from, last_step = 0.2;
  for (int n = 10; n <= 80; ++n) {
    feedback_[0] = position();
    step(n * kPeriod_ns);
    const double moved = position() - before;
    EXPECT_LE(std::abs(moved - last_step), 0.02) << "no jump at " << n;
    last_step = moved;
    before = position();
  }
  EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_LOST);
  // 200 mm/s: at most five periods of bridge, then 200² / (2 · 5000) = 4 mm.
  EXPECT_LT(position() - from, 5 * 0.2 + 4 + 0.1);
  for (int n = 81; n <= 90; ++n) {  // the process comes back as if nothing had been
    send(n);
    step(n * kPeriod_ns);
    EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_LOST);
    EXPECT_EQ(position(), feedback_[0]);
  }
  send(91, false);
  step(91 * kPeriod_ns);
  send(92);
  step(92 * kPeriod_ns);
  step(93 * kPeriod_ns);
  EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_FOLLOWS);
}

/// Times of HAL's calls after a stall that ends at `end`: it makes up for what it missed at once.
std::vector<std::int64_t> calls_after_stall(int missed, int end, int ordinary) {
  std::vector<std::int64_t> times;
  for (int i = 0; i <= missed; ++i) times.push_back(end * kPeriod_ns + i * 1'000);
  for (int n = end + 1; n <= end + ordinary; ++n) times.push_back(n * kPeriod_ns);
  return times;
}

TEST_F(Follow, AStallOfTheServoThreadIsNoJumpAndIsCaughtUpOnThePath) {
  constexpr int kStalls[] = {3, 10, 40};
  for (const int missed : kStalls) {
    follow_ = {};
    shared_ = {};
    run_to(10);
    const int end = 9 + missed;
    for (int n = 11; n <= end + 1; ++n) send(n);  // the process goes on
    double farthest = 0;
    for (const std::int64_t now_ns : calls_after_stall(missed, end, 1000)) {
      if (now_ns % kPeriod_ns == 0) send(static_cast<int>(now_ns / kPeriod_ns) + 1);
      farthest = std::max(farthest, farthest_step({now_ns}));
      ASSERT_EQ(follow_.phase[0], MERIDIAN_HAL_FOLLOWS);
      const double led_s = 1e-9 * static_cast<double>(follow_.time_ns - kPeriod_ns);
      ASSERT_NEAR(position(), position_at(led_s), 1e-6) << "on the path, " << missed << " missed";
    }
    EXPECT_LE(farthest, 2.26 * 0.2) << "two periods at 200 mm/s, and an eighth; missed " << missed;
    EXPECT_NEAR(position(), position_at(1e-9 * static_cast<double>((end + 999) * kPeriod_ns)), 1e-4)
        << "caught up";
  }
}

TEST_F(Follow, BehindAStallOfManyHoursTimeGoesOnAtNineEighthsOfThePaceToo) {
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  for (const std::int64_t stalled_ns : {kHour_ns, 2 * kHour_ns, 1000 * kHour_ns}) {
    follow_.phase[0] = MERIDIAN_HAL_FOLLOWS;
    follow_.called_ns = follow_.time_ns = kPeriod_ns;
    meridian_hal_time(&follow_, kPeriod_ns + stalled_ns, kPeriod_ns);
    EXPECT_EQ(follow_.time_ns, kPeriod_ns + 2 * kPeriod_ns * 9 / 8) << stalled_ns;
  }
}

TEST_F(Follow, ARampBehindAStallBeginsWhereAndAsFastAsTheJointWasLed) {
  run_to(10);
  const double from = position();
  EXPECT_LE(farthest_step(calls_after_stall(200, 209, 100)), 2 * 0.2);
  EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_LOST);
  EXPECT_NEAR(position() - from, 199 * 199 / (2 * 5000.0), 0.05) << "the ramp, and nothing else";
}

TEST_F(Follow, AStallInTheRampDoesNotLengthenIt) {
  for (const int missed : {5, 60, 900}) {
    follow_ = {};
    shared_ = {};
    run_to(10);
    for (int n = 10; n <= 20; ++n) step(n * kPeriod_ns);
    ASSERT_EQ(follow_.phase[0], MERIDIAN_HAL_RAMPS);
    const double from = position(), speed = follow_.velocity[0];
    EXPECT_LE(farthest_step(calls_after_stall(missed, 20 + missed, 100)), 2 * 0.2);
    EXPECT_NEAR(position() - from, speed * speed / (2 * 5000), 1e-9) << missed;
  }
}

TEST_F(Follow, AStallBehindWhichSetpointsAreGoneRampsDown) {
  run_to(10);
  const int missed = MERIDIAN_HAL_KEPT + 20, end = 9 + missed;
  for (int n = 11; n <= end + 1; ++n) send(n);
  EXPECT_LE(farthest_step({end * kPeriod_ns}), 2 * 0.2);
  EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_RAMPS);
  EXPECT_TRUE(follow_.is_silent) << "nothing turns meanwhile";
}

TEST_F(Follow, AComponentThatIsLoadedUnderARunningProcessStaysOff) {
  for (int n = 1; n <= 10; ++n) {
    send(n);
    step(n * kPeriod_ns);
    EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_LOST);
  }
}

TEST_F(Follow, AProcessThatIsGoneIsNoticedWithEveryJointOff) {
  step(1 * kPeriod_ns);
  EXPECT_TRUE(follow_.is_silent) << "none was there yet";
  for (int n = 2; n <= 5; ++n) {
    send(n, false);
    step(n * kPeriod_ns);
    EXPECT_FALSE(follow_.is_silent);
  }
  for (int n = 6; n <= 9; ++n) step(n * kPeriod_ns);
  EXPECT_FALSE(follow_.is_silent) << "inside the bridge";
  step(10 * kPeriod_ns);
  EXPECT_TRUE(follow_.is_silent);
  send(11, false);
  step(11 * kPeriod_ns);
  EXPECT_FALSE(follow_.is_silent);
}

TEST_F(Follow, OffItIsWhereTheJointIs) {
  send(1, false);
  feedback_[0] = 7;
  step(1 * kPeriod_ns);
  EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_OFF);
  EXPECT_EQ(position(), 7);
}

TEST_F(Follow, VelocitiesThatDoNotBelongToThePositionsDoNotSwing) {
  begin(2);
  for (int n = 3; n <= 12; ++n) {
    meridian_hal_setpoint one{};
    one.number = static_cast<std::uint64_t>(n);
    one.end_ns = n * kPeriod_ns;
    one.velocity[0] = n % 2 == 0 ? 1e6 : -1e6;
    one.on_mask = 1;
    meridian_hal_write(&shared_.setpoint_lock, &shared_.setpoints[n % MERIDIAN_HAL_KEPT], &one,
                       sizeof one);
    step((n - 1) * kPeriod_ns);
    step((n - 1) * kPeriod_ns + kPeriod_ns / 2);
    if (n > 5) {
      EXPECT_EQ(position(), 0) << n;
    }
  }
}

}  // namespace
