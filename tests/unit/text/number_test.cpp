// SPDX-License-Identifier: Apache-2.0
#include "service/text/number.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace meridian::text {
namespace {

TEST(Number, IsTheWholeTextOrNone) {
  double value = 0;
  EXPECT_TRUE(read_number("-12.5e1", value));
  EXPECT_EQ(value, -125);
  for (const char* const text : {"", " 1", "1 ", "1,2", "1mm", "+1", "0x10", "one"}) {
    EXPECT_FALSE(read_number(text, value)) << text;
  }
}

TEST(Number, OfAKindThatCannotHoldItIsNone) {
  std::uint8_t value = 0;
  EXPECT_TRUE(read_number("255", value));
  EXPECT_EQ(value, 255);
  for (const char* const text : {"256", "-1", "1.0"})
    EXPECT_FALSE(read_number(text, value)) << text;
}

TEST(Number, ThatIsNotFiniteIsNoneWhereAFiniteOneIsWanted) {
  double value = 0;
  EXPECT_TRUE(read_finite("1e308", value));
  for (const char* const text : {"inf", "-inf", "nan"}) {
    EXPECT_TRUE(read_number(text, value)) << text;
    EXPECT_FALSE(read_finite(text, value)) << text;
  }
}

}  // namespace
}  // namespace meridian::text
