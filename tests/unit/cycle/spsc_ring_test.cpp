// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "unit/cycle/ports_under_test.hpp"

namespace meridian {
namespace {

using testing::Item;
using namespace std::chrono_literals;

TEST(SpscRing, GivesItemsBackInOrder) {
  SpscRing<int, 4> ring;
  EXPECT_TRUE(ring.try_push(1));
  EXPECT_TRUE(ring.try_push(2));
  int item = 0;
  ASSERT_TRUE(ring.try_pop(item));
  EXPECT_EQ(item, 1);
  ASSERT_TRUE(ring.try_pop(item));
  EXPECT_EQ(item, 2);
  EXPECT_FALSE(ring.try_pop(item));
}

TEST(SpscRing, RefusesWhenFullAndTakesAgainAfterAPop) {
  SpscRing<int, 2> ring;
  EXPECT_TRUE(ring.try_push(1));
  EXPECT_TRUE(ring.try_push(2));
  EXPECT_FALSE(ring.try_push(3));
  EXPECT_EQ(ring.size(), 2u);
  int item = 0;
  ASSERT_TRUE(ring.try_pop(item));
  EXPECT_TRUE(ring.try_push(3));
}

TEST(SpscRing, ShowsStagedItemsOnlyWhenPublished) {
  SpscRing<int, 8> ring;
  EXPECT_TRUE(ring.stage(1));
  EXPECT_TRUE(ring.stage(2));
  EXPECT_EQ(ring.peek(0), nullptr);
  ring.publish();
  ASSERT_NE(ring.peek(1), nullptr);
  EXPECT_EQ(*ring.peek(1), 2);
}

TEST(SpscRing, ForgetsWhatWasStagedAndDiscarded) {
  SpscRing<int, 4> ring;
  EXPECT_TRUE(ring.try_push(1));
  EXPECT_TRUE(ring.stage(2));
  ring.discard_staged();
  EXPECT_TRUE(ring.try_push(3));
  EXPECT_EQ(*ring.peek(1), 3);
  EXPECT_EQ(ring.size(), 2u);
}

TEST(SpscRing, LooksAheadWithoutTaking) {
  SpscRing<int, 4> ring;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.try_push(i));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(*ring.peek(i), static_cast<int>(i));
  EXPECT_EQ(ring.peek(4), nullptr);
  ring.drop(3);
  EXPECT_EQ(*ring.peek(0), 3);
  EXPECT_EQ(ring.count_free_slots(), 3u);
}

TEST(SpscRing, LosesAndTearsNothingBetweenTwoThreads) {
  const auto ring = std::make_unique<SpscRing<Item, 8>>();
  const testing::Trial trial = testing::try_ring(*ring, 20s, false);
  EXPECT_GE(trial.items, testing::kEnoughItems);
  EXPECT_EQ(trial.faults, 0u);
}

#if !defined(__SANITIZE_THREAD__)  // the twins race on purpose
TEST(SpscRing, TheTrialCatchesATwinThatPublishesTooEarly) {
  const auto ring = std::make_unique<testing::RingThatPublishesTooEarly<Item, 8>>();
  EXPECT_GT(testing::try_ring(*ring, 20s, true).faults, 0u);
}

TEST(SpscRing, TheTrialCatchesATwinThatFreesTooEarly) {
  const auto ring = std::make_unique<testing::RingThatFreesTooEarly<Item, 8>>();
  EXPECT_GT(testing::try_ring(*ring, 20s, true).faults, 0u);
}
#endif

}  // namespace
}  // namespace meridian
