// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/sent_setpoint.hpp"

#include <gtest/gtest.h>

namespace meridian::bridge {
namespace {

constexpr std::uint64_t kService = 7, kOther = 8;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

[[nodiscard]] dds::SetpointSample sample_of(std::uint64_t service_id, double velocity,
                                            std::uint16_t flags = kSetpointEnabled) {
  dds::SetpointSample out;
  out.setpoint.flags = flags;
  out.setpoint.velocity[0] = velocity;
  out.crc = dds::setpoint_crc(out.setpoint, service_id);
  return out;
}

TEST(SentSetpoint, IsTheNewestOfTheServiceThatTheDrivesObey) {
  SentSetpoint sent;
  EXPECT_FALSE(sent.add(sample_of(kService, 5), 0)) << "nobody is obeyed yet";
  sent.follow(kService);
  EXPECT_TRUE(sent.add(sample_of(kService, 5), 0));
  EXPECT_FALSE(sent.add(sample_of(kOther, 9), 0)) << "of another service";
  ASSERT_TRUE(sent.get());
  EXPECT_EQ(sent.get()->velocity[0], 5);
  sent.follow(0);
  EXPECT_TRUE(sent.get()) << "the drives do not say";
  sent.follow(kOther);
  EXPECT_FALSE(sent.get()) << "another one leads";
}

TEST(SentSetpoint, SpoiltOnesAndThoseOfADryRunAreNotUsed) {
  SentSetpoint sent;
  sent.follow(kService);
  dds::SetpointSample spoilt = sample_of(kService, 5);
  spoilt.setpoint.velocity[0] = 500;
  EXPECT_FALSE(sent.add(spoilt, 0));
  EXPECT_FALSE(sent.add(sample_of(kService, 5, kSetpointDry), 0));
  EXPECT_FALSE(sent.get());
}

TEST(SentSetpoint, AServiceThatIsGoneLeavesNoVelocityBehind) {
  SentSetpoint sent;
  sent.follow(kService);
  ASSERT_TRUE(sent.add(sample_of(kService, 5), 0));
  sent.pass(100 * kMillisecond_ns);
  EXPECT_TRUE(sent.get());
  sent.pass(101 * kMillisecond_ns);
  EXPECT_FALSE(sent.get());
}

}  // namespace
}  // namespace meridian::bridge
