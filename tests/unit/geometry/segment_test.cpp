// SPDX-License-Identifier: Apache-2.0
#include "meridian/geometry/segment.hpp"

#include <gtest/gtest.h>

namespace meridian {
namespace {

TEST(Segment, IsAsFarAsItsNearestPoint) {
  const Vector3 a{0, 0, 0}, b{10, 0, 0};
  EXPECT_DOUBLE_EQ(distance_to_segment({4, 3, 0}, a, b), 3);
  EXPECT_DOUBLE_EQ(distance_to_segment({-3, 4, 0}, a, b), 5) << "before its begin";
  EXPECT_DOUBLE_EQ(distance_to_segment({13, 0, 4}, a, b), 5) << "beyond its end";
  EXPECT_DOUBLE_EQ(distance_to_segment({7, 0, 0}, a, b), 0);
}

TEST(Segment, OfNoLengthIsAPoint) {
  EXPECT_DOUBLE_EQ(distance_to_segment({3, 4, 0}, {0, 0, 0}, {0, 0, 0}), 5);
}

}  // namespace
}  // namespace meridian
