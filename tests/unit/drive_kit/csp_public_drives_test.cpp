// SPDX-License-Identifier: Apache-2.0
// Process data of three drives on the market, byte by byte. Their mappings are those of the object
// dictionaries that their makers publish in their EtherCAT slave information.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "meridian/drive.hpp"
#include "meridian/drive_csp.hpp"

namespace meridian::drive {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Omron R88D-1SN, objects 1702h and 1B02h.
[[nodiscard]] CspSpec omron() {
  CspSpec spec;
  spec.name = "X";
  spec.outputs = {{0x60400010, {}}, {0x607A0020, {}}, {0x60FF0020, 0},         {0x60710010, 0},
                  {0x60600008, {}}, {0x60B80010, {}}, {0x607F0020, 0x01020304}};
  spec.inputs = {{0x603F0010, {}}, {0x60410010, {}}, {0x60640020, {}},
                 {0x60770010, {}}, {0x60610008, {}}, {0x60B90010, {}},
                 {0x60BA0020, {}}, {0x60BC0020, {}}, {0x60FD0020, {}}};
  spec.counts_per_unit = counts_per_unit(8'388'608, 1, 1, 1, 16);  // 23 bits, pitch 16 mm
  spec.travel_min = -400;
  spec.travel_max = 400;
  return spec;
}

/// Delta ASDA-A2-E, objects 1600h and 1A00h.
[[nodiscard]] CspSpec delta() {
  CspSpec spec;
  spec.name = "Y";
  spec.outputs = {
      {0x60400010, {}}, {0x607A0020, {}}, {0x60FF0020, 0}, {0x60710010, 0}, {0x60600008, {}}};
  spec.inputs = {
      {0x60410010, {}}, {0x60640020, {}}, {0x606C0020, {}}, {0x60770010, {}}, {0x60610008, {}}};
  spec.counts_per_unit = -counts_per_unit(1'280'000, 1, 1, 1, 10);  // the motor is turned round
  // 606Ch is in tenths of a turn per minute: mm/s of the screw, counted against the axis.
  spec.velocity_counts_per_unit = -600.0 / 10;
  return spec;
}

/// Festo CMMT-ST, objects 1600h and 1A00h.
[[nodiscard]] CspSpec festo() {
  CspSpec spec;
  spec.name = "Z";
  spec.outputs = {{0x60400010, {}}, {0x60600008, {}}, {0x607A0020, {}}, {0x60810020, 0x7FFFFFFF},
                  {0x60FF0020, 0},  {0x60710010, 0},  {0x60B10020, {}}, {0x60B20010, 0}};
  spec.inputs = {
      {0x60410010, {}}, {0x60610008, {}}, {0x60640020, {}}, {0x606C0020, {}}, {0x60770010, {}}};
  spec.counts_per_unit = counts_per_si_unit(0xFA010000, false);  // the drive counts micrometres
  return spec;
}

[[nodiscard]] Bytes written(CspDrive& drive, const Output& output) {
  Bytes frame(drive.output_bytes(), 0xEE);
  drive.write(output, frame);
  return frame;
}

TEST(CspPublicDrives, OmronIsReadAndWrittenByteByByte) {
  CspDrive drive(omron());
  ASSERT_EQ(drive.output_bytes(), 19U);
  ASSERT_EQ(drive.input_bytes(), 25U);
  // Operation enabled (0237h), at 00200000h counts = 4 mm, mode 8, probe not stored.
  Bytes in{0x00, 0x00, 0x37, 0x02, 0x00, 0x00, 0x20, 0x00, 0x34, 0x12, 0x08, 0x01, 0x00,
           0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00};
  (void)drive.read(in);
  (void)written(drive, {.is_on = true, .position = 4});
  const Reading reading = drive.read(in);
  EXPECT_DOUBLE_EQ(reading.position, 4);
  EXPECT_TRUE(std::isnan(reading.velocity)) << "606Ch is not mapped";
  EXPECT_TRUE(reading.is_ready);
  EXPECT_EQ(reading.error, 0);
  // 4.5 mm are 2359296 = 00240000h counts; the largest velocity is what was given.
  EXPECT_EQ(written(drive, {.is_on = true, .position = 4.5, .velocity = 100}),
            (Bytes{0x0F, 0x00, 0x00, 0x00, 0x24, 0x00, 0, 0, 0, 0, 0, 0, 0x08, 0x15, 0x00, 0x04,
                   0x03, 0x02, 0x01}));
  // The zero pulse at 00180000h counts = 3 mm.
  in[11] = 0x03;
  in[15] = 0x18;
  const Reading index = drive.read(in);
  EXPECT_TRUE(index.is_index);
  EXPECT_DOUBLE_EQ(index.index_position, 3);
  EXPECT_EQ(written(drive, {.is_on = true, .position = 4.5})[13], 0x00) << "arms it anew";
  EXPECT_FALSE(drive.read(in).is_index) << "one period alone";
}

TEST(CspPublicDrives, DeltaCountsAgainstTheAxis) {
  CspDrive drive(delta());
  ASSERT_EQ(drive.output_bytes(), 13U);
  ASSERT_EQ(drive.input_bytes(), 13U);
  // -128000 counts = FFFE0C00h are +1 mm; -600 tenths of a turn per minute are +10 mm/s.
  const Bytes in{0x37, 0x02, 0x00, 0x0C, 0xFE, 0xFF, 0xA8, 0xFD, 0xFF, 0xFF, 0x00, 0x00, 0x08};
  (void)drive.read(in);
  (void)written(drive, {.is_on = true, .position = 1});
  const Reading reading = drive.read(in);
  EXPECT_DOUBLE_EQ(reading.position, 1);
  EXPECT_DOUBLE_EQ(reading.velocity, 10);
  // -2 mm are 256000 = 0003E800h.
  EXPECT_EQ(written(drive, {.is_on = true, .position = -2}),
            (Bytes{0x0F, 0x00, 0x00, 0xE8, 0x03, 0x00, 0, 0, 0, 0, 0, 0, 0x08}));
}

TEST(CspPublicDrives, FestoTakesVelocityAsFeedForward) {
  CspDrive drive(festo());
  ASSERT_EQ(drive.output_bytes(), 23U);
  ASSERT_EQ(drive.input_bytes(), 13U);
  // 12345 micrometres = 00003039h, 5 mm/s.
  const Bytes in{0x37, 0x12, 0x08, 0x39, 0x30, 0x00, 0x00, 0x88, 0x13, 0x00, 0x00, 0x00, 0x00};
  (void)drive.read(in);
  (void)written(drive, {.is_on = true, .position = 12.345});
  const Reading reading = drive.read(in);
  EXPECT_DOUBLE_EQ(reading.position, 12.345);
  EXPECT_DOUBLE_EQ(reading.velocity, 5);
  // 12.350 mm = 0000303Eh, 5 mm/s = 00001388h.
  EXPECT_EQ(written(drive, {.is_on = true, .position = 12.350, .velocity = 5}),
            (Bytes{0x0F, 0x00, 0x08, 0x3E, 0x30, 0x00, 0x00, 0xFF, 0xFF, 0xFF, 0x7F, 0,
                   0,    0,    0,    0,    0,    0x88, 0x13, 0x00, 0x00, 0,    0}));
}

}  // namespace
}  // namespace meridian::drive
