// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/sent_times.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace meridian::interpolator {
namespace {

TEST(SentTimes, KnowsTheNewestSetpointsAndForgetsOlderOnes) {
  SentTimes times;
  EXPECT_EQ(times.sent_ns(0), 0);
  for (std::uint64_t cycle = 0; cycle <= SentTimes::kSlots; ++cycle) {
    times.note(cycle, 1000 + static_cast<std::int64_t>(cycle));
  }
  EXPECT_EQ(times.sent_ns(0), 0);
  EXPECT_EQ(times.sent_ns(1), 1001);
  EXPECT_EQ(times.sent_ns(SentTimes::kSlots), 1000 + static_cast<std::int64_t>(SentTimes::kSlots));
  EXPECT_EQ(times.sent_ns(SentTimes::kSlots + 1), 0);
}

TEST(SentTimes, NeverGivesTheTimeOfAnotherSetpoint) {
  const auto times = std::make_unique<SentTimes>();
  std::atomic<bool> is_enough{false};
  std::atomic<std::uint64_t> newest{0};
  std::thread writer([&] {
    for (std::uint64_t cycle = 1; !is_enough; ++cycle) {
      times->note(cycle, static_cast<std::int64_t>(cycle) * 7);
      newest.store(cycle, std::memory_order_release);
    }
  });
  int found = 0, wrong = 0;
  while (newest < SentTimes::kSlots) std::this_thread::yield();
  for (int looks = 0; looks < 300'000; ++looks) {
    const std::uint64_t cycle = newest.load(std::memory_order_acquire);
    // The newest, one in the middle, and the one that the writer is about to take the place of.
    for (const std::uint64_t back :
         {std::uint64_t{0}, SentTimes::kSlots / 2, SentTimes::kSlots - 1}) {
      if (cycle <= back) continue;
      const std::int64_t sent = times->sent_ns(cycle - back);
      found += sent != 0;
      wrong += sent != 0 && sent != static_cast<std::int64_t>(cycle - back) * 7;
    }
  }
  is_enough = true;
  writer.join();
  EXPECT_GT(found, 100);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(times->sent_ns(newest), static_cast<std::int64_t>(newest.load()) * 7);
}

}  // namespace
}  // namespace meridian::interpolator
