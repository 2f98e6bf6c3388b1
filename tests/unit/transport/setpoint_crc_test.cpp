// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <vector>

#include "service/transport/convert/convert.hpp"
#include "service/transport/convert/crc32c.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::dds {
namespace {

constexpr std::uint64_t kService = 0x0123456789ABCDEFULL;

Setpoint some_setpoint() {
  Setpoint setpoint;
  setpoint.cycle = 4711;
  setpoint.due_ns = 4'711'000'000;
  setpoint.position = {1, -2, 3.25, 1e-9, 5, 0};
  setpoint.velocity = {-10, 20, 0, 0.5, 0, 0};
  setpoint.line = 12;
  setpoint.epoch = 3;
  setpoint.flags = kSetpointEnabled | kSetpointMoving;
  return setpoint;
}

TEST(SetpointCrc, IsThatOfTheServiceIdAndTheBytesOnTheWireBeforeIt) {
  SetpointSample sample{some_setpoint(), 0};
  sample.crc = setpoint_crc(sample.setpoint, kService);
  meridian_wire_Setpoint wire{};
  to_wire(sample, wire);
  std::vector<std::byte> bytes;  // little-endian, as the serialized sample is
  for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<std::byte>(kService >> (8 * i) & 0xFFU));
  const std::size_t payload = offsetof(meridian_wire_Setpoint, crc32c);
  ASSERT_EQ(payload, 120U);
  bytes.resize(8 + payload);
  std::memcpy(bytes.data() + 8, &wire, payload);
  EXPECT_EQ(wire.crc32c, crc32c(bytes));
}

TEST(SetpointCrc, FitsNoOtherServiceAndNoSetpointWithOneBitChanged) {
  const Setpoint setpoint = some_setpoint();
  const std::uint32_t crc = setpoint_crc(setpoint, kService);
  EXPECT_NE(crc, setpoint_crc(setpoint, kService + 1));
  EXPECT_NE(crc, setpoint_crc(setpoint, 0));
  for (std::size_t bit = 0; bit < 8 * sizeof setpoint; ++bit) {
    std::array<unsigned char, sizeof setpoint> bytes{};
    std::memcpy(bytes.data(), &setpoint, sizeof setpoint);
    bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ 1U << bit % 8);
    Setpoint spoilt;
    std::memcpy(&spoilt, bytes.data(), sizeof spoilt);
    EXPECT_NE(crc, setpoint_crc(spoilt, kService)) << "bit " << bit;
  }
}

/// The publisher computes one per cycle.
TEST(SetpointCrc, TakesLessThanAMicrosecond) {
  constexpr int kTimes = 100'000;
  Setpoint setpoint = some_setpoint();
  std::uint32_t sum = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int n = 0; n < kTimes; ++n) {
    ++setpoint.cycle;
    sum += setpoint_crc(setpoint, kService);
  }
  const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - begin;
  std::printf("%.0f ns each (%08x)\n", passed.count() / kTimes, sum);
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(passed.count() / kTimes, 1000);
#endif
}

}  // namespace
}  // namespace meridian::dds
