// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/index_ring.hpp"

#include <gtest/gtest.h>

namespace meridian {
namespace {

TEST(IndexRing, NamesElementsByAnIndexThatStays) {
  IndexRing<int> ring(4);
  for (int n = 0; n < 4; ++n) ring.push(10 * n);
  EXPECT_TRUE(ring.is_full());
  ring.drop_before(2);
  ring.push(40);
  EXPECT_EQ(ring.begin_index(), 2);
  EXPECT_EQ(ring.end_index(), 5);
  EXPECT_EQ(ring[2], 20);
  EXPECT_EQ(ring.back(), 40);
  ring.drop_before(9);
  EXPECT_EQ(ring.begin_index(), 5) << "not beyond what was added";
}

TEST(IndexRing, LosesTheOldestWhereItIsFullAndSoAsked) {
  IndexRing<int> ring(2);
  for (int n = 1; n <= 5; ++n) ring.push_over_oldest(n);
  int out = 0;
  ASSERT_TRUE(ring.take_oldest(out));
  EXPECT_EQ(out, 4);
  ASSERT_TRUE(ring.take_oldest(out));
  EXPECT_EQ(out, 5);
  EXPECT_FALSE(ring.take_oldest(out));
  ring.push_over_oldest(6);
  ASSERT_TRUE(ring.take_oldest(out));
  EXPECT_EQ(out, 6);
}

}  // namespace
}  // namespace meridian
