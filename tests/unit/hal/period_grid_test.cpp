// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/period_grid.hpp"

#include <gtest/gtest.h>

namespace meridian::hal {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

TEST(PeriodGrid, EndsAreAPeriodApartThoughWakeUpsAreNot) {
  PeriodGrid grid(kPeriod_ns);
  std::int64_t before = grid.end_of(10 * kPeriod_ns, 1e-3);
  EXPECT_EQ(before, 11 * kPeriod_ns);
  for (int n = 11; n < 1000; ++n) {
    const std::int64_t late = n % 2 == 0 ? 800'000 : 0;
    const std::int64_t end = grid.end_of(n * kPeriod_ns + late, 1e-3);
    // It gives way by a 256th of how far it is off, which is less than four periods.
    EXPECT_NEAR(static_cast<double>(end - before), 1e6, 4e6 / 256) << n;
    before = end;
  }
  EXPECT_NEAR(static_cast<double>(before), 1000.4e6, 0.05e6) << "in the middle of the wake-ups";
}

TEST(PeriodGrid, TwoSetpointsAtOnceAndThenNoneAreWhereTheyBelong) {
  PeriodGrid grid(kPeriod_ns);
  const std::int64_t first = grid.end_of(10 * kPeriod_ns, 1e-3);
  const std::int64_t two = grid.end_of(11 * kPeriod_ns, 2e-3);
  EXPECT_NEAR(static_cast<double>(two - first), 2e6, 1e6 / 256);
  const std::int64_t bridged = grid.end_of(12 * kPeriod_ns, 1e-3);
  EXPECT_NEAR(static_cast<double>(bridged - two), 1e6, 1e6 / 256);
  const std::int64_t same = grid.end_of(13 * kPeriod_ns, 0);
  EXPECT_GE(same, bridged);
  EXPECT_LT(same, bridged + 1000) << "the bridge was there already";
}

TEST(PeriodGrid, SetpointsThatWereHeldUpLeaveNoLagBehind) {
  PeriodGrid grid(kPeriod_ns);
  (void)grid.end_of(10 * kPeriod_ns, 1e-3);
  (void)grid.end_of(16 * kPeriod_ns, 1e-3);  // six periods late, and one setpoint of the six is there
  const std::int64_t end = grid.end_of(17 * kPeriod_ns, 6e-3);  // the others, and the newest
  EXPECT_NEAR(static_cast<double>(end), 18e6, 0.05e6);
}

TEST(PeriodGrid, DoesNotRunAheadWithASenderWhoseCyclesAreShorterThanItSays) {
  PeriodGrid grid(kPeriod_ns);
  for (int n = 10; n < 200; ++n) {
    EXPECT_LE(grid.end_of(n * kPeriod_ns, 2e-3), (n + 9) * kPeriod_ns) << n;
  }
}

TEST(PeriodGrid, BeginsAnewBehindAStall) {
  PeriodGrid grid(kPeriod_ns);
  (void)grid.end_of(10 * kPeriod_ns, 1e-3);
  EXPECT_EQ(grid.end_of(50 * kPeriod_ns, 1e-3), 51 * kPeriod_ns);
  EXPECT_EQ(grid.end_of(60 * kPeriod_ns, 10e-3), 61 * kPeriod_ns) << "lost periods are counted";
}

}  // namespace
}  // namespace meridian::hal
