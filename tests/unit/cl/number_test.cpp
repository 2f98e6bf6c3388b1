// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace meridian::cl {
namespace {

double value_of(std::string_view text) {
  double value = 0;
  EXPECT_TRUE(parse_number(text, value)) << text;
  return value;
}

TEST(Number, TakesLeadingAndTrailingDots) {
  EXPECT_EQ(value_of(".5"), 0.5);
  EXPECT_EQ(value_of("-.2338901349"), -0.2338901349);
  EXPECT_EQ(value_of("25."), 25.0);
  EXPECT_EQ(value_of("-0.0000000"), 0.0);
  EXPECT_EQ(value_of("007"), 7.0);
}

TEST(Number, TakesSignsAndExponentsOfBothLanguages) {
  EXPECT_EQ(value_of("+1.5"), 1.5);
  EXPECT_EQ(value_of("+.5"), 0.5);
  EXPECT_EQ(value_of("1.25E+03"), 1250.0);
  EXPECT_EQ(value_of("1.25D-02"), 0.0125);
}

TEST(Number, RefusesWhatIsNoNumber) {
  double value = 0;
  for (const char* text : {"", "-", ".", "+", "20MM", "1.2.3", "NAN", "INF", "-INF", "1E", "1E999",
                           "0x10", "1,5", "--1", "+-1"}) {
    EXPECT_FALSE(parse_number(text, value)) << text;
  }
}

TEST(Number, RoundsAsTheLibraryDoesForEveryLength) {
  std::mt19937_64 random(7);  // seed 7
  std::uniform_int_distribution<int> decimals(0, 18);
  std::uniform_real_distribution<double> magnitude(-9, 6);
  for (int i = 0; i < 20000; ++i) {
    std::array<char, 64> text{};
    const double drawn = (i % 2 == 0 ? 1 : -1) * std::pow(10.0, magnitude(random));
    std::snprintf(text.data(), text.size(), "%.*f", decimals(random), drawn);
    double value = 0;
    ASSERT_TRUE(parse_number(text.data(), value)) << text.data();
    ASSERT_EQ(value, std::strtod(text.data(), nullptr)) << text.data();
  }
}

}  // namespace
}  // namespace meridian::cl
