// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/sent_times.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace meridian::interpolator {
namespace {

TEST(SentTimes, KnowsTheNewestSetpointsAndForgetsOlderOnes) {
  SentTimes times;
  EXPECT_EQ(times.sent_ns(0), 0);
  for (std::uint64_t cycle = 0; cycle <= SentTimes::kPlaces; ++cycle) {
    times.note(cycle, 1000 + static_cast<std::int64_t>(cycle));
  }
  EXPECT_EQ(times.sent_ns(0), 0);
  EXPECT_EQ(times.sent_ns(1), 1001);
  EXPECT_EQ(times.sent_ns(SentTimes::kPlaces),
            1000 + static_cast<std::int64_t>(SentTimes::kPlaces));
  EXPECT_EQ(times.sent_ns(SentTimes::kPlaces + 1), 0);
}

TEST(SentTimes, NeverGivesTheTimeOfAnotherSetpoint) {
  const auto times = std::make_unique<SentTimes>();
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    for (std::uint64_t cycle = 1; cycle < 400'000; ++cycle) {
      times->note(cycle, static_cast<std::int64_t>(cycle) * 7);
    }
    is_over = true;
  });
  for (std::uint64_t cycle = 1; !is_over; cycle = cycle % 400'000 + 1) {
    const std::int64_t sent = times->sent_ns(cycle);
    if (sent == 0) continue;
    ASSERT_EQ(sent, static_cast<std::int64_t>(cycle) * 7);
  }
  writer.join();
  EXPECT_EQ(times->sent_ns(399'999), 399'999 * 7);
}

}  // namespace
}  // namespace meridian::interpolator
