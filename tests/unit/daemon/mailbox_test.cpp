// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/mailbox.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace meridian::interpolator {
namespace {

TEST(Mailbox, GivesWhatWasPutOnce) {
  Mailbox<std::string> box;
  std::string value = "old";
  EXPECT_FALSE(box.try_take(value));
  EXPECT_EQ(value, "old");
  std::string news = "new";
  EXPECT_TRUE(box.try_put(news));
  EXPECT_TRUE(box.try_take(value));
  EXPECT_EQ(value, "new");
  EXPECT_FALSE(box.try_take(value));
}

TEST(Mailbox, GivesTheNewestOfSeveral) {
  Mailbox<std::string> box;
  for (std::string news : {"first", "second", "third"}) EXPECT_TRUE(box.try_put(news));
  std::string value;
  EXPECT_TRUE(box.try_take(value));
  EXPECT_EQ(value, "third");
}

TEST(Mailbox, LeavesTheOldValueToTheWriter) {
  Mailbox<std::string> box;
  std::string value = "old", news = "new";
  EXPECT_TRUE(box.try_put(news));
  EXPECT_TRUE(box.try_take(value));
  std::string newer = "newer";
  EXPECT_TRUE(box.try_put(newer));
  EXPECT_EQ(newer, "old");
}

TEST(Mailbox, PassesWholeValuesBetweenThreads) {
  constexpr int kLast = 20'000;
  Mailbox<std::vector<int>> box;
  std::thread writer([&box] {
    for (int n = 1; n <= kLast; ++n) {
      std::vector<int> value(static_cast<std::size_t>(1 + n % 7), n);
      while (!box.try_put(value)) std::this_thread::yield();
    }
  });
  std::vector<int> value;
  int before = 0;
  while (before < kLast) {
    if (!box.try_take(value)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(value,
              std::vector<int>(static_cast<std::size_t>(1 + value.front() % 7), value.front()));
    ASSERT_GT(value.front(), before);
    before = value.front();
  }
  writer.join();
}

}  // namespace
}  // namespace meridian::interpolator
