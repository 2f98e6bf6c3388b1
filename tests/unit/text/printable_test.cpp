// SPDX-License-Identifier: Apache-2.0
#include "service/text/printable.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace meridian::text {
namespace {

using namespace std::string_literals;

TEST(Printable, LeavesWhatIsFitForALineAsItIs) {
  for (const std::string text : {"", "cam-1", "C:\\parts\\blade 7.apt", "Fräser Ø6 – 刀具 😀"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_TRUE(is_printable(text));
  }
}

TEST(Printable, EscapesWhatATerminalOrALogActsOn) {
  const std::pair<std::string, std::string> cases[] = {
      {"a\nb", "a\\nb"},
      {"a\r\tb", "a\\r\\tb"},
      {"\x1b[2Jx", "\\x1B[2Jx"},
      {"a\x7f"s, "a\\x7F"},
      {"a\0b"s, "a\\x00b"},
      {"\xC2\x9B"
       "31m",
       "\\u009B31m"},  // C1: CSI
      {"a\x9B"
       "31m",
       "a\\x9B31m"},  // the same as a byte
      {"\xE2\x80\xAE"
       "tpa",
       "\\u202Etpa"},  // right to left
      {"a\xE2\x80\xA8"
       "b",
       "a\\u2028b"},                        // line separator
      {"\xC0\x8A", "\\xC0\\x8A"},           // overlong newline
      {"\xED\xA0\x80", "\\xED\\xA0\\x80"},  // surrogate
      {"\xF4\x90\x80\x80", "\\xF4\\x90\\x80\\x80"},
      {"Fr\xC3", "Fr\\xC3"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(printable(text), expected);
    EXPECT_FALSE(is_printable(text)) << expected;
  }
  EXPECT_EQ(printable("a\nb\x1b", std::string::npos, Newlines::kKept), "a\nb\\x1B");
}

TEST(Printable, OfAnythingIsPrintableAndTheSameWhenDoneTwice) {
  constexpr unsigned kSeed = 20261123;
  std::mt19937 engine(kSeed);
  for (int n = 0; n < 20'000; ++n) {
    std::string text(engine() % 24, '\0');
    for (char& c : text) c = static_cast<char>(engine());
    const std::string once = printable(text);
    ASSERT_TRUE(is_printable(once)) << "seed " << kSeed << ", draw " << n;
    ASSERT_EQ(printable(once), once);
    const std::size_t max = engine() % 30;
    const std::string cut = printable(text, max);
    ASSERT_LE(cut.size(), max);
    ASSERT_EQ(once.rfind(cut, 0), 0U);
    ASSERT_TRUE(is_printable(cut));
  }
}

TEST(Printable, CutsBetweenCharacters) {
  EXPECT_EQ(printable("abc", 2), "ab");
  EXPECT_EQ(printable("aü", 2), "a");
  EXPECT_EQ(printable("a\nb", 2), "a");
  EXPECT_EQ(whole_characters("aü", 2), 1U);
  EXPECT_EQ(whole_characters("aü", 3), 3U);
  EXPECT_EQ(whole_characters("😀", 3), 0U);
  EXPECT_EQ(whole_characters("\x80\x80\x80\x80\x80", 3), 3U) << "no character at all";
}

}  // namespace
}  // namespace meridian::text
