// SPDX-License-Identifier: Apache-2.0
// HELICAL, as CATIA writes it: a whole helix in one statement.
#include <gtest/gtest.h>

#include <numbers>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kTight_rad = 1e-9;
constexpr double kCircle = 2 * std::numbers::pi;

/// From (10, 0, 0) about z.
std::string helix(const std::string& forward, const std::string& angle, const std::string& height,
                  const std::string& end) {
  return "GOTO/10,0,0\nHELICAL/CENTER, 0, 0, 0, INDIRV, " + forward +
         ", AXIS, 0, 0, 1,$\n PITCH, 1, RADIUS, 10, ANGLE, " + angle + ", HEIGHT, " + height +
         ", ROUND, 2, END, " + end + "\n";
}

TEST(Helix, TurnsAsItsDirectionSaysAndAsOftenAsItsAngle) {
  const auto left = read_body(helix("0,1,0", "810", "9", "0,10,-9")).motion();
  ASSERT_EQ(left.size(), 4U);
  EXPECT_NEAR(left[1].sweep_rad, kCircle, kTight_rad);
  EXPECT_NEAR(left[1].tip_mm[2], -4, kTight_rad);
  EXPECT_NEAR(left[2].tip_mm[2], -8, kTight_rad);
  EXPECT_NEAR(left[3].sweep_rad, kCircle / 4, kTight_rad);
  EXPECT_EQ(left[3].tip_mm, (Array3{0, 10, -9}));
  EXPECT_GT(left[3].normal[2], 0);
  const auto right = read_body(helix("0,-1,0", "270", "3", "0,10,3")).motion();
  ASSERT_EQ(right.size(), 2U);
  EXPECT_NEAR(right[1].sweep_rad, kCircle * 3 / 4, kTight_rad);
  EXPECT_LT(right[1].normal[2], 0);
}

TEST(Helix, OfWholeTurnsMayMissItsBeginByTheLastDigitOfTheFile) {
  for (const char* const end : {"10,0,2", "10,0.00001,2", "10,-0.00001,2"}) {
    const auto read = read_body(helix("0,1,0", "720", "2", end));
    ASSERT_EQ(read.error, "") << end;
    double sweep = 0;
    for (const ClBlock& block : read.motion()) sweep += block.is_arc ? block.sweep_rad : 0;
    EXPECT_NEAR(sweep, 2 * kCircle, 1e-5) << end;
  }
}

TEST(Helix, IsReadFromItsNumbersAlone) {
  const auto read = read_body("GOTO/10,0,0\nHELICAL/0,0,0,0,1,0,0,0,1,4,10,90,1,1,0,10,1\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().at(1).tip_mm, (Array3{0, 10, 1}));
}

TEST(Helix, WhosePartsContradictEachOtherIsRefused) {
  for (const auto& [text, reason] :
       {std::pair{helix("0,1,0", "80", "1", "0,10,1"), "an angle of 80 deg"},
        {helix("0,1,0", "0.01", "0", "10,0,0"), "an angle of 0.01 deg"},
        {helix("0,1,0", "90", "4", "0,10,1"), "a height of 4 mm"},
        {helix("1,0,0", "90", "1", "0,10,1"), "INDIRV does not give the sense"},
        {helix("0,1,0", "90", "1", "0,11,1"), "one circle"},
        {helix("0,1,0", "0", "1", "0,10,1"), "no helix"}}) {
    const auto read = read_body(text);
    EXPECT_NE(read.error.find("part.apt:4"), std::string::npos) << read.error;
    EXPECT_NE(read.error.find(reason), std::string::npos) << read.error;
  }
  EXPECT_NE(read_body("GOTO/10,0,0\nHELICAL/0,0,0,0,1,0,0,0,1,10,0,10,1\n").error, "");
}

}  // namespace
}  // namespace meridian::cl
