// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "meridian/drive.hpp"
#include "meridian/drive_csp.hpp"

namespace meridian::drive {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(CspUnits, CountsOfAScrewAndOfARotaryTable) {
  // 2^23 counts a turn, gear 1:1, pitch 10 mm.
  EXPECT_DOUBLE_EQ(counts_per_unit(8'388'608, 1, 1, 1, 10), 838'860.8);
  // 2^20 counts a turn, 90 turns of the motor for one of the table.
  EXPECT_DOUBLE_EQ(counts_per_unit(1'048'576, 1, 90, 1, 2 * kPi), 1'048'576 * 90 / (2 * kPi));
}

TEST(CspUnits, SiUnitsAreThoseOfTheStandard) {
  struct Row {
    std::uint32_t unit;  // prefix, numerator, denominator, 0
    bool is_rotary;
    double counts;
  };
  const Row table[] = {
      {0xFA010000, false, 1000},             // micrometres
      {0xF7010000, false, 1e6},              // nanometres
      {0x00010300, false, 1e-3},             // metres per second
      {0xFD410000, true, 1000 * 180 / kPi},  // thousandths of a degree
      {0xFD100000, true, 1000},              // milliradians
      {0x00B44700, true, 60 / (2 * kPi)},    // turns per minute
      {0xFFB44700, true, 600 / (2 * kPi)},   // tenths of a turn per minute
      {0x00410300, true, 180 / kPi},         // degrees per second
  };
  for (const Row& row : table) {
    EXPECT_NEAR(counts_per_si_unit(row.unit, row.is_rotary), row.counts, 1e-12 * row.counts)
        << std::hex << row.unit;
  }
}

TEST(CspUnits, RefusesWhatIsNoUnitOfTheAxis) {
  EXPECT_THROW((void)counts_per_si_unit(0x00B50000, true), DriveError) << "increments";
  EXPECT_THROW((void)counts_per_si_unit(0x00B40000, false), DriveError) << "turns of a screw";
  EXPECT_THROW((void)counts_per_si_unit(0x00010000, true), DriveError) << "metres of a table";
  EXPECT_THROW((void)counts_per_si_unit(0x00014800, false), DriveError) << "per hour";
  EXPECT_THROW((void)counts_per_unit(0, 1, 1, 1, 10), DriveError);
  EXPECT_THROW((void)counts_per_unit(1, 1, 1, 1, 0), DriveError);
}

}  // namespace
}  // namespace meridian::drive
