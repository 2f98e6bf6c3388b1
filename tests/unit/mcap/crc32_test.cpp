// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/crc32.hpp"

#include <gtest/gtest.h>

#include <string>

namespace meridian::mcap {
namespace {

TEST(Crc32, IsTheOneWhoseCheckIsCbf43926) {
  EXPECT_EQ(crc32_of("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32_of(""), 0U);
  EXPECT_EQ(crc32_of("a"), 0xE8B7BE43U);
}

TEST(Crc32, IsTheSameHoweverTheBytesCome) {
  std::string text;
  for (int i = 0; i < 41; ++i) text.push_back(static_cast<char>(7 * i * i));
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Crc32 crc;
    crc.add(std::string_view(text).substr(0, cut));
    crc.add(std::string_view(text).substr(cut));
    EXPECT_EQ(crc.sum(), crc32_of(text)) << cut;
  }
}

}  // namespace
}  // namespace meridian::mcap
