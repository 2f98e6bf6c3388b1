// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/csp_layout.hpp"

#include <gtest/gtest.h>

#include <array>

#include "meridian/drive.hpp"

namespace meridian::drive {
namespace {

TEST(CspLayout, NumbersAreLittleEndianInTheOrderOfTheMapping) {
  const CspLayout layout("X", {{0x60400010, {}}, {0x60600008, {}}, {0x607A0020, {}}}, 0);
  ASSERT_EQ(layout.bytes(), 7U);
  std::array<std::uint8_t, 7> frame{};
  layout.find(CspObject::kControlword).put(frame, 0x010F);
  layout.find(CspObject::kMode).put(frame, 8);
  layout.find(CspObject::kTargetPosition).put(frame, -2);
  EXPECT_EQ(frame, (std::array<std::uint8_t, 7>{0x0F, 0x01, 0x08, 0xFE, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(layout.find(CspObject::kTargetPosition).get_signed(frame), -2);
  EXPECT_EQ(layout.find(CspObject::kControlword).get(frame), 0x010FU);
}

TEST(CspLayout, BitsAndPaddingShiftWhatFollows) {
  // Three single bits of a maker, five of padding, then the statusword.
  const CspLayout layout(
      "X",
      {{0x20000101, {}}, {0x20000201, {}}, {0x20000301, {}}, {0x00000005, {}}, {0x60410010, {}}},
      0);
  ASSERT_EQ(layout.bytes(), 3U);
  const std::array<std::uint8_t, 3> frame{0x05, 0x37, 0x12};
  EXPECT_EQ(layout.find(CspObject::kStatusword).get(frame), 0x1237U);
  EXPECT_EQ(layout.entries()[0].field.get(frame), 1U);
  EXPECT_EQ(layout.entries()[1].field.get(frame), 0U);
}

TEST(CspLayout, ANumberMayLieAcrossBytes) {
  const CspLayout layout("X", {{0x20000104, {}}, {0x60640020, {}}}, 0);
  ASSERT_EQ(layout.bytes(), 5U);
  std::array<std::uint8_t, 5> frame{0x0A, 0, 0, 0, 0};
  layout.find(CspObject::kPosition).put(frame, 0x12345678);
  EXPECT_EQ(frame, (std::array<std::uint8_t, 5>{0x8A, 0x67, 0x45, 0x23, 0x01}));
}

TEST(CspLayout, AFurtherAxisHasItsObjects800hHigher) {
  const CspLayout layout("C", {{0x68400010, {}}, {0x687A0020, {}}}, 0x800);
  EXPECT_TRUE(layout.find(CspObject::kControlword));
  EXPECT_TRUE(layout.find(CspObject::kTargetPosition));
}

[[nodiscard]] std::string refusal(const std::vector<PdoEntry>& entries) {
  try {
    const CspLayout layout("X", entries, 0);
  } catch (const DriveError& error) {
    return error.what();
  }
  return "";
}

TEST(CspLayout, RefusesLengthsThatTheStandardDoesNotHave) {
  EXPECT_NE(refusal({{0x607A0010, {}}}).find("607Ah:00 is mapped with 16 bits, and has 32"),
            std::string::npos);
  EXPECT_NE(refusal({{0x60600010, {}}}).find("6060h:00"), std::string::npos);
  EXPECT_NE(refusal({{0x20000000, {}}}).find("must have 1 to 64"), std::string::npos);
  EXPECT_NE(refusal({{0x60400010, {}}, {0x60400010, {}}}).find("mapped twice"), std::string::npos);
}

}  // namespace
}  // namespace meridian::drive
