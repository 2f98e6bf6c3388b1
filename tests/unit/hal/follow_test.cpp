// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/component/follow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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
    meridian_hal_step(&follow_, &shared_, &setup_, now_ns, feedback_);
  }
  [[nodiscard]] double position() const { return follow_.position[0]; }
  /// Off, then on from period `first` on; the servo thread at its begin.
  void begin(int first) {
    send(first - 1, false);
    step((first - 1) * kPeriod_ns);
    send(first);
    step(first * kPeriod_ns);
  }

  meridian_hal_shared shared_{};
  meridian_hal_setup setup_{};
  meridian_hal_follow follow_{};
  double feedback_[MERIDIAN_HAL_JOINTS] = {};
};

TEST_F(Follow, PositionsAreThoseOfOnePeriodAgoWhateverThePeriodsAre) {
  for (const std::int64_t servo_ns : {250'000, 700'000, 1'000'000, 1'300'000, 2'000'000}) {
    follow_ = {};
    shared_ = {};
    begin(2);
    std::mt19937 engine(11);
    std::uniform_int_distribution<std::int64_t> late(0, 900'000);
    int sent = 2;
    std::int64_t next_ns = 2 * kPeriod_ns + late(engine);  // the period that ends at 3 is written
    double before = 0;
    for (std::int64_t now = 3 * kPeriod_ns; now < 1500 * kPeriod_ns; now += servo_ns) {
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
  begin(2);
  for (int n = 3; n <= 10; ++n) {
    send(n);
    step((n - 1) * kPeriod_ns);
  }
  for (int n = 11; n <= 60; ++n) {  // each comes when its time is over already
    step(n * kPeriod_ns + 900'000);
    EXPECT_NEAR(position(), position_at(1e-9 * static_cast<double>((n - 1) * kPeriod_ns + 900'000)),
                2e-3);
    send(n);
  }
}

TEST_F(Follow, LateSetpointsAreBridgedByTheVelocity) {
  begin(2);
  for (int n = 3; n <= 10; ++n) {
    send(n);
    step((n - 1) * kPeriod_ns);
  }
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
  begin(2);
  for (int n = 3; n <= 10; ++n) {
    send(n);
    step((n - 1) * kPeriod_ns);
  }
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
  EXPECT_EQ(follow_.phase[0], MERIDIAN_HAL_FOLLOWS);
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
