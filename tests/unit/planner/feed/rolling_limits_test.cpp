// SPDX-License-Identifier: Apache-2.0

/// Limits that the rolling feed keeps beside those of joints on an even path.

#include <gtest/gtest.h>

#include "unit/planner/feed/rolled_feed.hpp"

namespace meridian::test::rolling_limits {
namespace {

TEST(RollingLimits, KeepsTheProgrammedFeedWhereItDropsAndRises) {
  for (const double slow : {5.0, 10.0, 20.0}) {
    Rolled one;
    for (int n = 0; n < 6; ++n) {
      one.add_straight(10, 2, 10, 80);
      one.add_straight(10, 0.5, 10, slow);
    }
    one.run();
    const FeedUse use = one.use(one.pieces());
    EXPECT_LE(use.b, 1.002) << slow;
    EXPECT_GT(use.b, 0.99);
    EXPECT_LE(use.worst(), 1 + 1e-6);
    EXPECT_EQ(one.feed.count().kept + one.feed.count().crawls, 0);
  }
}

/// As many limits as there may be: five joints, and the two drives that carry two of them.
TEST(RollingLimits, KeepsTheLimitsOfTheDrivesOfAStageToo) {
  Rolled one(without_reserve(), hybrid_machine());
  one.at[3] = -0.8;
  one.start = one.at;
  for (int n = 0; n < 32; ++n) {
    JointVector end = one.at;
    end[0] += 0.5;
    end[3] += 0.05;
    FeedSpan span;
    span.path = make_joint_move(one.at, end, 0b11000);
    span.length = span.path.length;
    span.cells = 10;
    one.spans.push_back(span);
    one.at = end;
  }
  one.run();
  expect_joined(one.pieces());
  const FeedUse use = one.use(one.pieces());
  EXPECT_LE(use.worst(), 1 + 1e-6);
  EXPECT_GT(use.worst(), 0.98);
  EXPECT_EQ(one.feed.count().kept + one.feed.count().crawls, 0);
}

}  // namespace
}  // namespace meridian::test::rolling_limits
