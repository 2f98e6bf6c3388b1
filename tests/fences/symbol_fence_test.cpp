// SPDX-License-Identifier: Apache-2.0
#include "fences/symbol_fence.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meridian::fences {
namespace {

bool is_comparable() {
#if defined(__clang__) || !defined(NDEBUG) || defined(__SANITIZE_ADDRESS__) || \
    defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

std::string banned_of(const std::set<std::string>& symbols) {
  std::string text;
  for (const std::string& symbol : symbols) {
    text += is_banned(symbol) ? symbol + "\n" : "";
  }
  return text;
}

#ifdef MERIDIAN_STEP_OBJECT
TEST(SymbolFence, TheCycleAsksForNothingButItsGoldenList) {
  if (!is_comparable()) {
    GTEST_SKIP() << "the golden list is of GCC's Release build, without sanitizers";
  }
  const auto golden = read_symbols(read_file(MERIDIAN_SOURCE_DIR, "tests/fences/step_symbols.txt"));
  const auto found = undefined_symbols(MERIDIAN_STEP_OBJECT);
  EXPECT_EQ(difference(golden, found), "");
  EXPECT_EQ(banned_of(golden), "");
}

TEST(SymbolFence, NothingInTheCycleThrowsOrAllocates) {
  if (!is_comparable()) {
    GTEST_SKIP() << "sanitizers and debug builds add symbols of their own";
  }
  EXPECT_EQ(banned_of(undefined_symbols(MERIDIAN_STEP_OBJECT)), "");
}
#endif

TEST(SymbolFence, CatchesHeapThrowAndLockOneLevelDown) {
  if (!is_comparable()) {
    GTEST_SKIP() << "sanitizers and debug builds add symbols of their own";
  }
  const auto found = undefined_symbols(MERIDIAN_BAD_OBJECT);
  for (const char* const symbol :
       {"operator new(unsigned long)", "__cxa_throw", "pthread_mutex_lock", "pow"}) {
    EXPECT_TRUE(found.contains(symbol)) << symbol;
  }
  EXPECT_FALSE(found.contains("tgamma")) << "code that the root does not reach was counted";
  EXPECT_NE(difference({"pow"}, found), "");
  EXPECT_NE(banned_of(found).find("operator new"), std::string::npos);
  EXPECT_NE(banned_of(found).find("__cxa_throw"), std::string::npos);
  EXPECT_NE(banned_of(found).find("pthread_mutex_lock"), std::string::npos);
}

TEST(SymbolFence, SaysWhatIsNewAndWhatIsGone) {
  EXPECT_EQ(difference({"atan2", "sqrt"}, {"atan2", "malloc"}), "new: malloc\ngone: sqrt\n");
  EXPECT_EQ(difference({"atan2"}, {"atan2"}), "");
}

}  // namespace
}  // namespace meridian::fences
