// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/limits_sum.hpp"

#include <gtest/gtest.h>

namespace meridian::stream {
namespace {

SoftLimits limits_of(std::size_t joint, double min, double max) {
  SoftLimits limits;
  EXPECT_TRUE(limits.put(joint, min, max));
  return limits;
}

TEST(LimitsSum, DistinguishesLimitsByAllThatTheySay) {
  const std::uint64_t sum = limits_sum(limits_of(1, -5, 5));
  EXPECT_EQ(limits_sum(limits_of(1, -5, 5)), sum);
  EXPECT_NE(limits_sum(SoftLimits()), 0U);
  EXPECT_NE(limits_sum(SoftLimits()), sum);
  EXPECT_NE(limits_sum(limits_of(2, -5, 5)), sum);
  EXPECT_NE(limits_sum(limits_of(1, -5 - 1e-12, 5)), sum);
  EXPECT_NE(limits_sum(limits_of(1, -5, 5 + 1e-12)), sum);
  SoftLimits boxed = limits_of(1, -5, 5);
  KeepOutBox box;
  box.joints = 0b10;
  box.min[1] = 1;
  box.max[1] = 2;
  boxed.put(box);
  EXPECT_NE(limits_sum(boxed), sum);
  SoftLimits other = limits_of(1, -5, 5);
  box.max[1] = 2 + 1e-12;
  other.put(box);
  EXPECT_NE(limits_sum(other), limits_sum(boxed));
  SoftLimits both = limits_of(1, -5, 5);
  both.put(0, -5, 5);
  EXPECT_NE(limits_sum(both), sum);
  SoftLimits tipped = limits_of(1, -5, 5), otherwise = tipped;
  tipped.put(TipBox{true, {0, 0, 0}, {1, 1, 1}});
  otherwise.put(TipBox{true, {0, 0, 0}, {1, 1, 1 + 1e-12}});
  EXPECT_NE(limits_sum(tipped), sum);
  EXPECT_NE(limits_sum(tipped), limits_sum(otherwise));
}

}  // namespace
}  // namespace meridian::stream
