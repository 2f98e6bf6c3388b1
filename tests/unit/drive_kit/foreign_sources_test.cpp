// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/foreign_sources.hpp"

#include <gtest/gtest.h>

namespace meridian::drive {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(ForeignSources, ReportsASourceOnceThatSendsForLongerThanATakeoverMayTake) {
  ForeignSources sources;
  EXPECT_FALSE(sources.is_to_be_reported(5, kSecond));
  EXPECT_FALSE(sources.is_to_be_reported(5, kSecond + kSecond / 10));
  EXPECT_TRUE(sources.is_to_be_reported(5, kSecond + kSecond / 2));
  EXPECT_FALSE(sources.is_to_be_reported(5, 9 * kSecond));
}

TEST(ForeignSources, ReportsNoTwoWithinASecondHoweverManySend) {
  ForeignSources sources;
  int reported = 0;
  for (std::int64_t now = kSecond; now <= 11 * kSecond; now += kSecond / 100) {
    for (std::uint64_t source = 1; source <= 60; ++source) {
      reported += sources.is_to_be_reported(source, now) ? 1 : 0;
    }
  }
  EXPECT_EQ(reported, 10);
}

}  // namespace
}  // namespace meridian::drive
