// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/participant_quota.hpp"

#include <gtest/gtest.h>

#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {
namespace {

using Result = ParticipantQuota::Result;

/// How many of `count` commands are allowed, sent over `span_ns` from `from_ns` on.
int allowed(ParticipantQuota& quota, std::uint64_t participant, int count, std::int64_t from_ns,
            std::int64_t span_ns) {
  int result = 0;
  for (int n = 0; n < count; ++n) {
    const std::int64_t now_ns = from_ns + span_ns * n / count;
    result += quota.take(participant, now_ns) == Result::kAllowed ? 1 : 0;
  }
  return result;
}

TEST(ParticipantQuota, LetsAnOverrideKnobAtFiftyASecondPassForever) {
  ParticipantQuota quota(200, 400);
  EXPECT_EQ(allowed(quota, 1, 50 * 600, kSecond_ns, 600 * kSecond_ns), 50 * 600);
}

TEST(ParticipantQuota, HoldsAFloodToTwoHundredASecondBehindTheFirstFourHundred) {
  ParticipantQuota quota(200, 400);
  const int passed = allowed(quota, 1, 100'000, kSecond_ns, 10 * kSecond_ns);
  EXPECT_GE(passed, 400 + 9 * 200);
  EXPECT_LE(passed, 400 + 10 * 200);
}

TEST(ParticipantQuota, OfOneParticipantIsNotThatOfAnother) {
  ParticipantQuota quota(200, 400);
  (void)allowed(quota, 1, 100'000, kSecond_ns, kSecond_ns);
  EXPECT_EQ(allowed(quota, 2, 400, 2 * kSecond_ns, 1000), 400);
}

TEST(ParticipantQuota, OfManyParticipantsForgetsTheOneThatWasSilentForLongest) {
  ParticipantQuota quota(200, 400);
  (void)allowed(quota, 1, 1000, kSecond_ns, 1000);
  for (std::uint64_t other = 2; other < 200; ++other) {
    EXPECT_EQ(quota.take(other, 2 * kSecond_ns + static_cast<std::int64_t>(other)),
              Result::kAllowed);
  }
  EXPECT_EQ(quota.take(199, 3 * kSecond_ns), Result::kAllowed);
}

TEST(ParticipantQuota, ReportsAFloodOnceThoughSomeOfItPasses) {
  ParticipantQuota quota(200, 400);
  int reports = 0;
  for (int n = 0; n < 50'000; ++n) {
    const auto result = quota.take(1, kSecond_ns + n * kSecond_ns / 10'000);
    reports += result == Result::kFirstBeyond ? 1 : 0;
  }
  EXPECT_EQ(reports, 1);
  (void)quota.take(1, 10 * kSecond_ns);
  reports = 0;
  for (int n = 0; n < 1000; ++n) {
    reports += quota.take(1, 10 * kSecond_ns) == Result::kFirstBeyond ? 1 : 0;
  }
  EXPECT_EQ(reports, 1) << "the next flood is reported again";
}

TEST(ParticipantQuota, OfSendersThatAreGoneIsOneForAll) {
  ParticipantQuota quota(200, 400);
  EXPECT_EQ(allowed(quota, 0, 1000, kSecond_ns, 1000), 400);
}

}  // namespace
}  // namespace meridian::interpolator
