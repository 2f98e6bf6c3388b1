// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/setpoint_age.hpp"

#include <gtest/gtest.h>

namespace meridian::drive {
namespace {

constexpr std::int64_t kMs = 1'000'000, kLongest = 4 * kMs;
constexpr std::int64_t kApart = -86'400'000 * kMs;  // a day between the two clocks

struct Wire {
  SetpointAge age;
  bool send(std::int64_t due_ns, std::int64_t delay_ns, bool is_off = false) {
    return age.is_late(due_ns, due_ns + kApart + delay_ns, kLongest, is_off);
  }
};

TEST(SetpointAge, IsThatBeyondTheLeastDelayWhateverTheClocksSay) {
  Wire wire;
  for (std::int64_t n = 0; n < 100; ++n) EXPECT_FALSE(wire.send(n * kMs, n % 3 * kMs));
  EXPECT_FALSE(wire.send(100 * kMs, 4 * kMs));
  EXPECT_TRUE(wire.send(101 * kMs, 5 * kMs)) << "held back";
  EXPECT_FALSE(wire.send(106 * kMs, 0)) << "the jam is over";
}

TEST(SetpointAge, FollowsClocksThatDriftApart) {
  Wire wire;
  constexpr double kDrift = 100e-6;
  for (std::int64_t n = 0; n < 3'600'000; ++n) {  // an hour
    const auto slow = static_cast<std::int64_t>(kDrift * static_cast<double>(n * kMs));
    ASSERT_FALSE(wire.send(n * kMs - slow, slow)) << n;
  }
}

TEST(SetpointAge, IsMeasuredAnewWhileDrivesAreOff) {
  Wire wire;
  EXPECT_FALSE(wire.send(0, 0));
  EXPECT_TRUE(wire.send(kMs, 500 * kMs)) << "the sender's host was suspended";
  EXPECT_FALSE(wire.send(2 * kMs, 500 * kMs, true));
  EXPECT_FALSE(wire.send(3 * kMs, 500 * kMs));
}

}  // namespace
}  // namespace meridian::drive
