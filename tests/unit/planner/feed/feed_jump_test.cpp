// SPDX-License-Identifier: Apache-2.0

/// A block that is slow by its own word between fast ones: a programme over both is badly scaled
/// and may find no plan, so that a window ends where what the feed allows jumps.

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "unit/planner/feed/rolled_feed.hpp"

namespace meridian::test::feed_jump {
namespace {

struct Block {
  double length = 0, speed = 0;  // mm, mm/s
};

Rolled rolled(const FeedSettings& settings, std::initializer_list<Block> blocks) {
  Rolled one(settings);
  for (const Block& block : blocks) one.add_straight(1, block.length, 0, block.speed);
  one.run();
  return one;
}

/// Cells as they are away from rests, at the ends of the path too.
FeedSettings evenly(FeedSettings settings) {
  settings.cells.rest_s = 1;
  return settings;
}

/// The first cell of a block.
std::int64_t begin_of(const Rolled& one, std::uint64_t block) {
  const auto pieces = one.pieces();
  const auto first = std::find_if(pieces.begin(), pieces.end(),
                                  [&](const FeedPiece& piece) { return piece.span == block; });
  return first == pieces.end() ? -1 : first->cell;
}

TEST(FeedJump, AWindowWithoutAPlanOverASlowBlockEndsBehindIt) {
  const Rolled one =
      rolled(evenly(feed_settings(bench_machine())), {{0.142, 80}, {0.19, 0.691}, {2.585, 80}});
  EXPECT_EQ(one.windows.front().rest_cell, begin_of(one, 2));
  EXPECT_LT(one.feed.grid().last(), 120) << "there was room for all of it";
  expect_joined(one.pieces());
  EXPECT_LE(one.use(one.pieces()).worst(), 1 + 1e-6);
}

TEST(FeedJump, EndingThereSavesTheTimeOfSofterPlans) {
  struct Case {
    Rolled one;
    double max_s;
  };
  const FeedSettings own = feed_settings(bench_machine());
  const Case cases[] = {
      {rolled(own, {{0.142, 80}, {0.19, 0.691}, {2.585, 80}}), 1.3},  // 1.17 s, else 1.74 s
      {rolled(without_reserve(), {{0.115, 80}, {0.114, 2.281}, {1.665, 80}}), 0.31},
      {rolled(own, {{0.063, 80}, {0.118, 1.06}, {0.032, 80}, {0.074, 0.046}}), 2.3},
      {rolled(own, {{3.373, 80}, {0.25, 0.492}, {1.723, 80}, {0.03, 0.01}, {0.273, 80}}), 5},
  };
  for (const Case& c : cases) EXPECT_LT(c.one.duration(), c.max_s);
}

TEST(FeedJump, IsNoEndWhereAPlanLeadsOverIt) {
  const Rolled one = rolled(evenly(without_reserve()), {{10, 80}, {3, 8}, {60, 80}});
  for (const RolledWindow& window : one.windows) {
    EXPECT_NE(window.rest_cell, begin_of(one, 1));
    EXPECT_NE(window.rest_cell, begin_of(one, 2));
  }
}

}  // namespace
}  // namespace meridian::test::feed_jump
