// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/cdr.hpp"

#include <gtest/gtest.h>

#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {
namespace {

using namespace std::string_view_literals;

TEST(Cdr, PutsEveryNumberAtAMultipleOfItsSizeFromTheContentsBegin) {
  Cdr cdr;
  cdr.begin().put(std::uint8_t{7}).put(std::uint16_t{0x0102}).put(std::uint8_t{8});
  cdr.put(std::uint32_t{0x01020304}).put(std::uint8_t{9}).put(1.0);
  EXPECT_EQ(cdr.bytes(),
            "\0\1\0\0"
            "\7\0\2\1\x08\0\0\0\4\3\2\1\x09\0\0\0"
            "\0\0\0\0\0\0\xF0\x3F"sv);
}

TEST(Cdr, CountsTheEndOfATextAndTakesATruthForAByte) {
  Cdr cdr;
  cdr.begin().put("ab").put(true).put(std::string()).put_count(2);
  EXPECT_EQ(cdr.bytes(), "\0\1\0\0\3\0\0\0ab\0\1\1\0\0\0\0\0\0\0\2\0\0\0"sv);
}

TEST(Cdr, CutsATimeIntoSecondsAndNanoseconds) {
  Cdr cdr;
  cdr.begin().put_header(3'000'000'007, "w");
  EXPECT_EQ(cdr.bytes(), "\0\1\0\0\3\0\0\0\7\0\0\0\2\0\0\0w\0"sv);
  cdr.begin();
  EXPECT_EQ(cdr.bytes(), "\0\1\0\0"sv);
}

TEST(RosUnits, AreMetresAndStayWhatTheyAreWhenReadAgain) {
  JointSpec linear, rotary;
  rotary.is_rotary = true;
  EXPECT_EQ(in_ros_units(linear, 250.0), 0.25);
  EXPECT_EQ(in_ros_units(rotary, 250.0), 250.0);
  EXPECT_NEAR(rounded(0.1234567890123456, kPositionPlaces), 0.1234567890123456, 4.7e-10);
  const double once = rounded(0.1234567890123456, kPositionPlaces);
  EXPECT_EQ(rounded(once, kPositionPlaces), once);
  EXPECT_EQ(rounded(-0.5, 40), -0.5);
  EXPECT_EQ(rounded(1e9 + 0.5, 40), 1e9 + 0.5) << "more digits than a double has";
}

}  // namespace
}  // namespace meridian::ros
