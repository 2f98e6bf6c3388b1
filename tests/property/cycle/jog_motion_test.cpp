// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "property/cycle/operated_run.hpp"
#include "support/draws.hpp"
#include "unit/cycle/hand.hpp"

/// Whatever a hand does to the joints, no limit of a joint or drive is passed in any cycle, and no
/// joint leaves its travel.
namespace meridian::test::jog_motion {
namespace {

using test::Hand;
using test::LimitShares;

constexpr std::uint64_t kSeed = 20251122;

/// A hand that changes its mind: velocities, reversals, other joints, nothing at all.
class RestlessHand {
 public:
  explicit RestlessHand(std::uint64_t seed)
      : random_(seed),
        hand_(seed % 2 == 0 ? test::lai_machine() : test::hybrid_machine(), start()) {}

  void jog(double seconds) {
    for (double t = 0; t < seconds;) {
      if (hand_.world.now() == State::kReady) {
        if (!hand_.lay_on(joint_)) return;
      }
      const double what = uniform(0, 1), time = std::exp(uniform(std::log(0.02), std::log(1.5)));
      if (what < 0.15) joint_ = static_cast<int>(uniform(0, 5));
      if (what < 0.85) {
        hand_.hold(joint_, velocity(), time);
      } else if (what < 0.97) {
        hand_.world.run_for(uniform(0, 0.3));
      } else {
        hand_.world.command(Verb::kAbort);
        (void)hand_.world.run_until(State::kReady, 2);
      }
      t += time;
    }
  }
  /// The last order was the last: everything comes to rest.
  [[nodiscard]] bool let_go() { return hand_.world.run_until(State::kReady, 3); }
  [[nodiscard]] Hand& hand() { return hand_; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }

 private:
  JointVector start() {
    JointVector at{};
    for (std::size_t i = 0; i < 5; ++i) at[i] = i < 3 ? uniform(-200, 200) : uniform(-0.9, 0.9);
    return at;
  }
  /// Any velocity up to one and a half times the limit, often the whole of it, sometimes none.
  double velocity() {
    const double max = hand_.world.machine.joints[static_cast<std::size_t>(joint_)].limits.velocity;
    const double what = uniform(0, 1);
    return what < 0.1 ? 0 : what < 0.3 ? max * (what < 0.2 ? -1.5 : 1.5) : uniform(-max, max);
  }

  std::mt19937_64 random_;
  int joint_ = 0;
  Hand hand_;
};

void expect_inside(const test::CycleWorld& world) {
  double beyond = 0;
  for (const CycleRecord& record : world.records) {
    const LimitedVector all = limited_of(world.machine, record.joints, record.setpoint.position);
    for (int i = 0; i < limited_count(world.machine); ++i) {
      const JointLimits& limits = limited_spec(world.machine, i).limits;
      const double q = all[static_cast<std::size_t>(i)];
      beyond = std::max({beyond, limits.travel_min - q, q - limits.travel_max});
    }
  }
  EXPECT_LE(beyond, 1e-9);
}

TEST(JogMotion, KeepsEveryLimitWhateverTheHandDoes) {
  constexpr int kHands = test::draws(120);
  LimitShares worst;
  int at_end = 0;
  for (int n = 0; n < kHands; ++n) {
    SCOPED_TRACE(testing::Message() << "hand " << n);
    RestlessHand restless(kSeed + static_cast<std::uint64_t>(n));
    restless.jog(12);
    EXPECT_TRUE(restless.let_go());
    const test::CycleWorld& world = restless.hand().world;
    EXPECT_EQ(world.count(EventCode::kAlarm), 0);
    test::expect_within_limits(world, 0, false, worst);
    expect_inside(world);
    for (int i = 0; i < limited_count(world.machine); ++i) {
      const double q = limited_value(world.machine, world.state.joints, i);
      const JointLimits& limits = limited_spec(world.machine, i).limits;
      at_end += std::min(limits.travel_max - q, q - limits.travel_min) < 1e-9;
    }
  }
  std::printf("seed %lu, %d hands: %d rests at an end of travel; worst v %.6f a %.6f j %.6f\n",
              static_cast<unsigned long>(kSeed), kHands, at_end, worst.v, worst.a, worst.j);
  EXPECT_GT(worst.v, 0.98);
  EXPECT_GT(worst.j, 0.95) << "the limits are used";
  EXPECT_GT(at_end, kHands / 10);
}

TEST(JogMotion, FromOutsideOfTravelADistanceIsKeptExactly) {
  constexpr int kHands = test::draws(60);
  std::mt19937_64 random(kSeed);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  LimitShares worst;
  for (int n = 0; n < kHands; ++n) {
    SCOPED_TRACE(testing::Message() << "hand " << n);
    const double sign = n % 2 == 0 ? -1 : 1;  // inwards
    JointVector at{};
    at[1] = -sign * (600 + uniform(0.1, 40));
    Hand hand(test::lai_machine(), at);
    ASSERT_TRUE(hand.lay_on(1));
    hand.distance = uniform(0.01, 80);
    hand.hold(1, sign * uniform(20, 400), uniform(0.02, 0.2));
    hand.hold(1, sign * uniform(20, 400), 5);
    EXPECT_NEAR(hand.world.state.joints[1], at[1] + sign * hand.distance, 1e-9);
    EXPECT_EQ(hand.world.state.velocity[1], 0);
    EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
    test::expect_within_limits(hand.world, 0, false, worst);
  }
}

TEST(JogMotion, AFaultStopKeepsItsHarderLimits) {
  constexpr int kHands = test::draws(60);
  LimitShares worst;
  for (int n = 0; n < kHands; ++n) {
    SCOPED_TRACE(testing::Message() << "hand " << n);
    RestlessHand restless(kSeed + 1000 + static_cast<std::uint64_t>(n));
    restless.jog(1 + restless.uniform(0, 1));
    test::CycleWorld& world = restless.hand().world;
    const std::size_t first = world.records.size();
    world.in.feedback.fault_mask = 1;
    EXPECT_TRUE(world.run_until(State::kFault, 1));
    test::expect_within_limits(world, first, true, worst);
    expect_inside(world);
  }
  std::printf("worst v %.6f a %.6f j %.6f\n", worst.v, worst.a, worst.j);
  EXPECT_GT(worst.a, 0.5);
}

}  // namespace
}  // namespace meridian::test::jog_motion
