// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/latest_value.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "unit/cycle/ports_under_test.hpp"

namespace meridian {
namespace {

using testing::Item;
using namespace std::chrono_literals;

TEST(LatestValue, HasItsInitialValueUntilOneIsStored) {
  LatestValue<int> port(7);
  int value = 0;
  EXPECT_FALSE(port.load(value));
  EXPECT_EQ(value, 7);
}

TEST(LatestValue, KeepsOnlyTheNewest) {
  LatestValue<int> port;
  for (int i = 1; i <= 5; ++i) port.store(i);
  int value = 0;
  EXPECT_TRUE(port.load(value));
  EXPECT_EQ(value, 5);
}

TEST(LatestValue, ReportsEachValueOnceAndKeepsIt) {
  LatestValue<int> port;
  port.store(3);
  EXPECT_TRUE(port.refresh());
  EXPECT_FALSE(port.refresh());
  EXPECT_EQ(port.latest(), 3);
}

TEST(LatestValue, WhatIsReadStaysUntilTheNextRefreshWhateverIsStored) {
  LatestValue<int> port(7);
  const int& initial = port.latest();
  for (int i = 1; i <= 3; ++i) {
    port.store(i);
    EXPECT_EQ(initial, 7);
  }
  for (int i = 10; i < 20; ++i) {
    EXPECT_TRUE(port.refresh());
    const int read = port.latest();
    const int& kept = port.latest();
    for (int k = 0; k < i % 4 + 1; ++k) {
      port.store(i + 100 * k);
      EXPECT_EQ(kept, read);
    }
  }
}

TEST(LatestValue, IsNeverTornNorOlderThanBeforeBetweenTwoThreads) {
  const auto port = std::make_unique<LatestValue<Item>>();
  const testing::Trial trial = testing::try_latest(*port, 20s, false);
  EXPECT_GE(trial.items, testing::kEnoughItems);
  EXPECT_EQ(trial.faults, 0u);
}

#if !defined(__SANITIZE_THREAD__)  // the twin races on purpose
TEST(LatestValue, TheTrialCatchesATwinWithTwoSlots) {
  const auto port = std::make_unique<testing::LatestValueWithTwoSlots<Item>>();
  EXPECT_GT(testing::try_latest(*port, 20s, true).faults, 0u);
}
#endif

}  // namespace
}  // namespace meridian
