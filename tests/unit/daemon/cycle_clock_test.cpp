// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/cycle_clock.hpp"

#include <gtest/gtest.h>

namespace meridian::interpolator {
namespace {

constexpr std::int64_t kStart_ns = 1'000'000'000'123, kPeriod_ns = 1'000'000;

TEST(CycleClock, IsDueAtStartPlusNPeriods) {
  CycleClock clock(kStart_ns, kPeriod_ns);
  for (std::int64_t n = 1; n <= 1000; ++n) {
    ASSERT_EQ(clock.next_due_ns(), kStart_ns + n * kPeriod_ns);
    const Period period = clock.woke_at(clock.next_due_ns() + 40'000);
    ASSERT_EQ(period.number, static_cast<std::uint64_t>(n));
    ASSERT_EQ(period.lost, 0U);
  }
}

TEST(CycleClock, SkipsWholePeriodsCountsThemAndKeepsPhase) {
  CycleClock clock(kStart_ns, kPeriod_ns);
  (void)clock.woke_at(clock.next_due_ns());
  const Period late = clock.woke_at(clock.next_due_ns() + 3 * kPeriod_ns + 17);
  EXPECT_EQ(late.lost, 3U);
  EXPECT_EQ(late.number, 5U);
  EXPECT_EQ(late.due_ns, kStart_ns + 5 * kPeriod_ns);
  EXPECT_EQ(clock.next_due_ns(), kStart_ns + 6 * kPeriod_ns);
}

TEST(CycleClock, LosesNothingByLessThanAPeriod) {
  CycleClock clock(kStart_ns, kPeriod_ns);
  EXPECT_EQ(clock.woke_at(clock.next_due_ns() + kPeriod_ns - 1).lost, 0U);
  EXPECT_EQ(clock.woke_at(clock.next_due_ns() + kPeriod_ns).lost, 1U);
}

TEST(CycleClock, TakesAnEarlyWakeForThePeriodThatIsDue) {
  CycleClock clock(kStart_ns, kPeriod_ns);
  const Period period = clock.woke_at(clock.next_due_ns() - 5);
  EXPECT_EQ(period.number, 1U);
  EXPECT_EQ(period.lost, 0U);
}

}  // namespace
}  // namespace meridian::interpolator
