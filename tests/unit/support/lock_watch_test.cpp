// SPDX-License-Identifier: Apache-2.0
#include "support/lock_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <shared_mutex>
#include <thread>

namespace meridian::watch {
namespace {

class LockWatchTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_lock_watched()) {
      GTEST_SKIP() << "the sanitizer owns the locks";
    }
  }
};

TEST_F(LockWatchTest, CatchesAnUncontendedMutex) {
  std::mutex mutex;
  const LockWatch watch;
  { const std::lock_guard lock(mutex); }
  EXPECT_EQ(watch.calls().locks, 1U);
  EXPECT_EQ(watch.calls().contended_locks, 0U);
}

TEST_F(LockWatchTest, CatchesReadWriteLocksAndConditionWaits) {
  std::shared_mutex shared;
  std::mutex mutex;
  std::condition_variable condition;
  const LockWatch watch;
  { const std::shared_lock lock(shared); }
  { const std::unique_lock lock(shared); }
  std::unique_lock lock(mutex);
  condition.wait_for(lock, std::chrono::microseconds(1));
  EXPECT_EQ(watch.calls().locks, 4U);
  EXPECT_EQ(watch.calls().contended_locks, 1U);  // a wait always waits
}

TEST_F(LockWatchTest, ReportsAContendedLock) {
  std::mutex mutex;
  std::atomic<bool> is_held{false};
  std::thread holder([&] {
    const std::lock_guard lock(mutex);
    is_held = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  while (!is_held) {
    std::this_thread::yield();
  }
  const LockWatch watch;
  { const std::lock_guard lock(mutex); }
  const LockCalls calls = watch.calls();
  holder.join();
  EXPECT_EQ(calls.locks, 1U);
  EXPECT_EQ(calls.contended_locks, 1U);
}

TEST_F(LockWatchTest, ReadsZeroForAtomics) {
  std::atomic<int> word{0};
  const LockWatch watch;
  for (int i = 0; i < 1000; ++i) {
    word.fetch_add(1);
  }
  EXPECT_EQ(watch.calls().locks, 0U);
  EXPECT_EQ(word.load(), 1000);
}

}  // namespace
}  // namespace meridian::watch
