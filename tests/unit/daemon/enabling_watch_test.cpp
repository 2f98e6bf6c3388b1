// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/enabling_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace meridian::interpolator {
namespace {

using Beat = EnablingWatch::Beat;
using dds::EnablingDevice;
constexpr std::int64_t kTimeout_ns = 300, kBegin_ns = 1000;

struct Watched {
  explicit Watched(bool is_required) { watch.set_up(is_required, kTimeout_ns); }
  /// Whether motion is held when the cycle looks then.
  bool holds_at(std::int64_t now_ns) {
    watch.look(now_ns);
    return watch.holds_back();
  }
  EnablingWatch watch;
};

TEST(EnablingWatch, HoldsNothingWhereNobodyAskedForIt) {
  Watched machine(false);
  EXPECT_FALSE(machine.holds_at(kBegin_ns));
}

TEST(EnablingWatch, HoldsOnceWhereADeviceFallsSilentThatHadBegun) {
  Watched machine(false);
  EXPECT_EQ(machine.watch.beat(5, EnablingDevice::kPressed, kBegin_ns), Beat::kBegun);
  EXPECT_FALSE(machine.holds_at(kBegin_ns + kTimeout_ns));
  EXPECT_TRUE(machine.holds_at(kBegin_ns + kTimeout_ns + 1));
  EXPECT_EQ(machine.watch.losses(), 1U);
  EXPECT_EQ(machine.watch.lost_source(), 5U);
  EXPECT_FALSE(machine.holds_at(kBegin_ns + kTimeout_ns + 2)) << "who resumes knows of it";
}

TEST(EnablingWatch, HoldsNothingWhileEveryHeartbeatComes) {
  Watched machine(true);
  for (std::int64_t now = kBegin_ns; now < kBegin_ns + 100 * kTimeout_ns; now += kTimeout_ns) {
    machine.watch.beat(5, EnablingDevice::kPressed, now);
    machine.watch.beat(6, EnablingDevice::kPressed, now);
    EXPECT_FALSE(machine.holds_at(now + kTimeout_ns - 1));
    EXPECT_EQ(machine.watch.pressed(), 2);
  }
}

TEST(EnablingWatch, HoldsWhereOneOfTwoDevicesFallsSilent) {
  Watched machine(true);
  machine.watch.beat(5, EnablingDevice::kPressed, kBegin_ns);
  machine.watch.beat(6, EnablingDevice::kPressed, kBegin_ns);
  machine.watch.beat(6, EnablingDevice::kPressed, kBegin_ns + kTimeout_ns);
  EXPECT_TRUE(machine.holds_at(kBegin_ns + kTimeout_ns + 1));
}

TEST(EnablingWatch, HoldsAtOnceWhereADeviceIsReleased) {
  Watched machine(false);
  machine.watch.beat(5, EnablingDevice::kPressed, kBegin_ns);
  EXPECT_FALSE(machine.holds_at(kBegin_ns + 1));
  EXPECT_EQ(machine.watch.beat(5, EnablingDevice::kReleased, kBegin_ns + 2), Beat::kReleased);
  EXPECT_TRUE(machine.holds_at(kBegin_ns + 3));
}

TEST(EnablingWatch, LetsADeviceLeaveThatSaysSoUnlessOneIsRequired) {
  for (const bool is_required : {false, true}) {
    Watched machine(is_required);
    machine.watch.beat(5, EnablingDevice::kPressed, kBegin_ns);
    EXPECT_EQ(machine.watch.beat(5, EnablingDevice::kLeaves, kBegin_ns + 1), Beat::kLeft);
    EXPECT_EQ(machine.holds_at(kBegin_ns + 2), is_required);
  }
}

TEST(EnablingWatch, HoldsAllTheTimeWhereOneIsRequiredAndNoneIsPressed) {
  Watched machine(true);
  for (std::int64_t now = kBegin_ns; now < 10 * kBegin_ns; now += 100) {
    EXPECT_TRUE(machine.holds_at(now));
  }
  machine.watch.beat(5, EnablingDevice::kReleased, kBegin_ns);
  EXPECT_TRUE(machine.holds_at(kBegin_ns)) << "one that is not pressed is none";
}

TEST(EnablingWatch, CountsNoMoreDevicesThanItHasPlacesFor) {
  Watched machine(false);
  for (std::uint64_t source = 1; source <= 8; ++source) {
    EXPECT_EQ(machine.watch.beat(source, EnablingDevice::kPressed, kBegin_ns), Beat::kBegun);
  }
  EXPECT_EQ(machine.watch.beat(9, EnablingDevice::kPressed, kBegin_ns), Beat::kNoRoom);
  EXPECT_TRUE(machine.holds_at(kBegin_ns + kTimeout_ns + 1));
  EXPECT_EQ(machine.watch.beat(9, EnablingDevice::kPressed, 2 * kBegin_ns), Beat::kBegun);
}

TEST(EnablingWatch, LosesNoHeartbeatThatComesWhileTheCycleLooks) {
  Watched machine(false);
  std::atomic<std::int64_t> clock_ns{kBegin_ns};
  std::atomic<bool> is_over{false};
  machine.watch.beat(5, EnablingDevice::kPressed, kBegin_ns);
  std::thread receiver([&] {
    while (!is_over) machine.watch.beat(5, EnablingDevice::kPressed, clock_ns.load());
  });
  int held = 0;
  for (int n = 0; n < 200'000; ++n) {
    const std::int64_t now_ns = clock_ns.load();
    held += machine.holds_at(now_ns) ? 1 : 0;
    clock_ns.store(now_ns + 1);
    if (n % 100 == 0) std::this_thread::yield();
  }
  is_over = true;
  receiver.join();
  // Where the receiver was not run for a whole timeout the device was lost, and began anew.
  EXPECT_EQ(static_cast<std::uint32_t>(held), machine.watch.losses());
}

}  // namespace
}  // namespace meridian::interpolator
