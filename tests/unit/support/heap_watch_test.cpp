// SPDX-License-Identifier: Apache-2.0
#include "support/heap_watch.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace meridian::watch {
namespace {

/// Keeps the compiler from proving that a heap call has no effect and dropping it.
void keep(void* block) { asm volatile("" : : "r"(block) : "memory"); }

class HeapWatchTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_heap_watched()) {
      GTEST_SKIP() << "the sanitizer owns malloc";
    }
  }
};

TEST_F(HeapWatchTest, CatchesOneNew) {
  const HeapWatch watch;
  int* const number = new int(1);
  keep(number);
  const HeapCalls at_new = watch.calls();
  delete number;
  EXPECT_EQ(at_new, (HeapCalls{1, 0}));
  EXPECT_EQ(watch.calls(), (HeapCalls{1, 1}));
}

TEST_F(HeapWatchTest, CatchesEveryWayToAllocate) {
  const HeapWatch watch;
  void* block = std::malloc(8);
  keep(block);
  block = std::realloc(block, 4096);
  keep(block);
  std::free(block);
  block = std::calloc(3, 8);
  keep(block);
  std::free(block);
  block = std::aligned_alloc(64, 128);
  keep(block);
  std::free(block);
  ASSERT_EQ(posix_memalign(&block, 64, 128), 0);
  keep(block);
  std::free(block);
  EXPECT_EQ(watch.calls(), (HeapCalls{5, 4}));
}

TEST_F(HeapWatchTest, CatchesAllocationsOfTheStandardLibrary) {
  const HeapWatch watch;
  {
    const std::string text(100, 'x');
    std::vector<double> numbers;
    numbers.push_back(1);
    keep(numbers.data());
    EXPECT_EQ(text.size(), 100U);
  }
  EXPECT_EQ(watch.calls(), (HeapCalls{2, 2}));
}

TEST_F(HeapWatchTest, ReadsZeroWhereNothingIsAllocated) {
  const HeapWatch watch;
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    sum += i;
  }
  std::free(nullptr);
  EXPECT_EQ(watch.calls(), (HeapCalls{0, 0}));
  EXPECT_EQ(sum, 499500);
}

TEST_F(HeapWatchTest, NamesWhoMadeTheFirstCalls) {
  const HeapWatch watch;
  int* const number = new int(1);
  keep(number);
  EXPECT_EQ(HeapWatch::callers({0, 0}), "");
  const std::string callers = HeapWatch::callers(watch.calls());
  EXPECT_EQ(callers.rfind("malloc < operator new(", 0), 0U) << callers;
  EXPECT_NE(callers.find("support_watch_test+0x"), std::string::npos)
      << "this very test: " << callers;
  delete number;
}

TEST_F(HeapWatchTest, CountsOnlyItsOwnThread) {
  HeapCalls other_thread;
  HeapCalls this_thread;
  std::thread([&] {
    const HeapWatch watch;
    for (int i = 0; i < 7; ++i) {
      const auto block = std::make_unique<int>(i);
      keep(block.get());
    }
    other_thread = watch.calls();
  }).join();
  const HeapWatch watch;
  this_thread = watch.calls();
  EXPECT_EQ(other_thread, (HeapCalls{7, 7}));
  EXPECT_EQ(this_thread, (HeapCalls{0, 0}));
}

}  // namespace
}  // namespace meridian::watch
