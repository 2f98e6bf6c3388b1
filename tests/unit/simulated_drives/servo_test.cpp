// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/servo.hpp"

#include <gtest/gtest.h>

namespace meridian::drives {
namespace {

constexpr double kPeriod_s = 1e-3;

class ServoOfKind : public testing::TestWithParam<LagKind> {};

TEST_P(ServoOfKind, SettlesOnAStandingTargetWithoutOvershoot) {
  ServoState state{0, 0};
  for (int i = 0; i < 200; ++i) {
    state = follow(state, 1.0, kPeriod_s, {GetParam(), 0.005});
    ASSERT_LE(state.position, 1.0);
  }
  EXPECT_NEAR(state.position, 1.0, 1e-9);
  EXPECT_NEAR(state.velocity, 0.0, 1e-6);
}

TEST_P(ServoOfKind, LagsByVelocityTimesTimeConstant) {
  constexpr double kVelocity = 100, kTimeConstant_s = 0.005;
  ServoState state{0, 0};
  double target = 0;
  // The target steps at the begin of each period: on average it leads by half a period.
  for (int i = 0; i < 1000; ++i) {
    target += kVelocity * kPeriod_s;
    state = follow(state, target, kPeriod_s, {GetParam(), kTimeConstant_s});
  }
  EXPECT_NEAR(target - state.position, kVelocity * (kTimeConstant_s - 0.5 * kPeriod_s),
              0.02 * kVelocity * kTimeConstant_s);
}

TEST_P(ServoOfKind, TwoHalfPeriodsAreOneWhole) {
  const ServoState from{0.3, -20};
  const ServoLag lag{GetParam(), 0.004};
  const ServoState once = follow(from, 1, kPeriod_s, lag);
  const ServoState twice = follow(follow(from, 1, kPeriod_s / 2, lag), 1, kPeriod_s / 2, lag);
  EXPECT_NEAR(once.position, twice.position, 1e-15);
  EXPECT_NEAR(once.velocity, twice.velocity, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Servo, ServoOfKind,
                         testing::Values(LagKind::kFirstOrder, LagKind::kSecondOrder));

TEST(Servo, NoTimeConstantFollowsAtOnce) {
  EXPECT_EQ(follow({0, 0}, 2, kPeriod_s, {LagKind::kSecondOrder, 0}).position, 2);
}

}  // namespace
}  // namespace meridian::drives
