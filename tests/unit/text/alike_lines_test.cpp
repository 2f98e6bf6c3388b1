// SPDX-License-Identifier: Apache-2.0
#include "service/text/alike_lines.hpp"

#include <gtest/gtest.h>

#include <string>

namespace meridian::text {
namespace {

TEST(AlikeLines, LetsAFewOfAKindPassAndCountsTheRest) {
  AlikeLines lines;
  int passed = 0;
  for (int n = 0; n < 1000; ++n) {
    passed +=
        lines.pass("malformed packet from vendor 1.16 at 0x7f" + std::to_string(n), n) ? 1 : 0;
  }
  EXPECT_EQ(passed, 5);
  EXPECT_TRUE(lines.pass("writer gone", 1000)) << "of another kind";
  EXPECT_TRUE(lines.counts(2000).empty()) << "its while is not over";
  const auto counts = lines.counts(AlikeLines::kWhile_ns);
  ASSERT_EQ(counts.size(), 1U);
  EXPECT_EQ(counts[0], "995 more lines like: malformed packet from vendor 1.16 at 0x7f0");
  EXPECT_TRUE(lines.pass("malformed packet from vendor 1.16 at 0x7f7", AlikeLines::kWhile_ns + 1));
}

TEST(AlikeLines, OfMoreKindsThanItKeepsLosesNoCount) {
  AlikeLines lines;
  std::int64_t now_ns = 0;
  for (int n = 0; n < 7; ++n) (void)lines.pass("first", ++now_ns);
  for (char c = 'A'; c <= 'Z'; ++c) {
    for (const char* end : {"", "x", "y"}) {
      EXPECT_TRUE(lines.pass(std::string("kind ") + c + end, ++now_ns));
    }
  }
  const auto counts = lines.counts(now_ns, true);
  ASSERT_EQ(counts.size(), 1U);
  EXPECT_EQ(counts[0], "2 more lines like: first");
}

}  // namespace
}  // namespace meridian::text
