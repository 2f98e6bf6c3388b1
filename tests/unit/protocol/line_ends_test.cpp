// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/line_ends.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace meridian::stream {
namespace {

TEST(LineEnds, KnowsTheLastBlockOfEveryLineOnceTheNextIsThere) {
  constexpr unsigned kSeed = 7;
  std::mt19937 engine(kSeed);
  LineEnds ends;
  std::vector<std::uint32_t> lines;
  std::uint32_t line = 1;
  std::uint64_t asked = 0;
  for (std::uint64_t sequence = 0; sequence < 20'000; ++sequence) {
    if (engine() % 3 != 0) line += static_cast<std::uint32_t>(1 + engine() % 3);
    ends.add(sequence, line);
    lines.push_back(line);
    ASSERT_FALSE(ends.is_line_end(sequence)) << "what follows is not known";
    for (; asked + 1 < lines.size() && engine() % 4 != 0; ++asked) {
      ASSERT_EQ(ends.is_line_end(asked), lines[asked + 1] != lines[asked]) << asked;
    }
  }
  ends.end();
  EXPECT_TRUE(ends.is_line_end(lines.size() - 1));
  EXPECT_FALSE(ends.is_line_end(lines.size()));
}

}  // namespace
}  // namespace meridian::stream
