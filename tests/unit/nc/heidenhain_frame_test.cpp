// SPDX-License-Identifier: Apache-2.0
// PLANE SPATIAL and datum shifts of Klartext, worked out by hand.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(KlartextPlane, TurnsAboutTheFixedAxesXThenYThenZ) {
  const ReadText read = read_klartext(
      "1 CYCL DEF 7.0 DATUM SHIFT\n2 CYCL DEF 7.1 X+10\n3 CYCL DEF 7.2 Y 20,5\n"
      "4 PLANE SPATIAL SPA+0 SPB+45 SPC+90 TURN FMAX SEQ- TABLE ROT\n"
      "5 L X+0 Y+0 Z+5 R0 FMAX\n6 L Z+0 F600\n7 L X+1\n8 PLANE RESET TURN FMAX\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  // About y by 45 the tool leans towards +x, about z by 90 that is +y.
  EXPECT_LT((axis(motion[1]) - Vector3(0, kHalfRoot, kHalfRoot)).norm(), kTiny);
  EXPECT_LT((tip(motion[1]) - Vector3(10, 20.5, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[2]) - Vector3(10, 20.5 + kHalfRoot, -kHalfRoot)).norm(), kTiny);
}

/// A point and a cut in a plane.
ReadText read_plane(const std::string& plane) {
  return read_klartext("1 PLANE " + plane + " TURN FMAX\n2 L X+1 Y+2 Z+5 R0 FMAX\n3 L Z+0 F600\n");
}

TEST(KlartextPlane, TurnsByEulersAnglesAboutZTheNewXAndTheNewZ) {
  // About z by 90: x is +y. About that x by 90: z is +x, y is +z. About that z by 90: x is +z.
  const ReadText read = read_plane("EULER EULPR+90 EULNU90 EULROT90");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  EXPECT_LT((axis(motion[1]) - Vector3(1, 0, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[0]) - Vector3(5, -2, 1)).norm(), kTiny);
  EXPECT_NE(read_plane("EULER EULPR+90 EULNU90").error.find("without EULROT"), std::string::npos);
}

TEST(KlartextPlane, LiesByItsVectors) {
  // x along +y, the normal along +x: y is +z.
  const ReadText read = read_plane("VECTOR BX+0 BY+2 BZ+0 NX+0,5 NY0 NZ0");
  ASSERT_EQ(read.error, "");
  EXPECT_LT((axis(read.motion()[1]) - Vector3(1, 0, 0)).norm(), kTiny);
  EXPECT_LT((tip(read.motion()[0]) - Vector3(5, 1, 2)).norm(), kTiny);
  for (const char* askew : {"VECTOR BX1 BY0 BZ1 NX0 NY0 NZ1", "VECTOR BX0 BY0 BZ0 NX0 NY0 NZ1"}) {
    EXPECT_NE(read_plane(askew).error.find("do not stand square"), std::string::npos) << askew;
  }
}

TEST(KlartextPlane, IsRefusedByNameInItsOtherForms) {
  for (const char* form : {"AXIAL B-45", "RELATIV SPB+45", "PROJECTED PROPR0 PROMIN20 ROT30",
                           "POINTS P1X0 P1Y0 P1Z0 P2X1 P2Y0 P2Z0 P3X0 P3Y1 P3Z0"}) {
    const ReadText read = read_plane(form);
    const std::string kind(form, std::string_view(form).find(' '));
    EXPECT_NE(read.error.find("PLANE " + kind + ": a plane"), std::string::npos) << read.error;
    EXPECT_NE(read.error.find("output PLANE SPATIAL"), std::string::npos) << read.error;
  }
}

TEST(KlartextPlane, WaitsForTheRotaryAxesUnderStay) {
  const std::string plane = "1 PLANE SPATIAL SPA+0 SPB+45 SPC+0 STAY\n";
  const std::string cut = "3 L X+0 Y+0 Z+5 FMAX\n4 L Z+0 F600\n";
  EXPECT_NE(read_klartext(plane + cut).error.find("does not stand across"), std::string::npos);
  const ReadText read = read_klartext(plane + "2 L B+Q121 C+Q122 R0 FMAX\n" + cut);
  ASSERT_EQ(read.error, "");
  EXPECT_LT((axis(read.motion()[1]) - Vector3(kHalfRoot, 0, kHalfRoot)).norm(), kTiny);
  EXPECT_NE(read_klartext(plane + "2 L X+1 B+Q121 C+Q122 FMAX\n").error.find("beside Q120"),
            std::string::npos);
}

TEST(KlartextDatum, ShiftsByTheAxisAndOnTop) {
  const ReadText read = read_klartext(
      "1 L X+1 Y+1 Z+1 R0 FMAX\n2 CYCL DEF 7.0 DATUM SHIFT\n3 CYCL DEF 7.1 X+10\n"
      "4 CYCL DEF 7.2 IX+5\n5 L X+1 Y+2 F600\n6 CYCL DEF 7.1 X+0\n7 L X+1\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(tip(motion[1]), Vector3(16, 2, 1));
  EXPECT_EQ(tip(motion[2]), Vector3(1, 2, 1));
}

/// The first point of a program whose datum is shifted before `preset` names a row.
ReadText read_preset(const std::string& preset) {
  return read_klartext("1 TRANS DATUM AXIS X+10 Y+5\n2 " + preset + "\n3 L X+1 Y+2 Z+5 R0 FMAX\n" +
                       "4 L Z+0 F600\n");
}

TEST(KlartextPreset, EndsTheDatumShiftUnlessItIsAskedToKeepIt) {
  for (const char* ends : {"PRESET SELECT #3", "PRESET SELECT NR3 WP",
                           "CYCL DEF 247 DATUM SETTING Q339=+3 ;DATUM NUMBER"}) {
    const ReadText read = read_preset(ends);
    ASSERT_EQ(read.error, "") << ends;
    EXPECT_EQ(read.summary.nc.work_offset, "CYCL DEF 247 Q339=3") << ends;
    EXPECT_LT((tip(read.motion().front()) - Vector3(1, 2, 5)).norm(), kTiny) << ends;
  }
  const ReadText kept = read_preset("PRESET SELECT #3 KEEP TRANS WP");
  ASSERT_EQ(kept.error, "");
  EXPECT_EQ(kept.summary.nc.work_offset, "CYCL DEF 247 Q339=3");
  EXPECT_LT((tip(kept.motion().front()) - Vector3(11, 7, 5)).norm(), kTiny);
}

TEST(KlartextPreset, IsRefusedWhereOnlyTheControlKnowsIt) {
  const std::vector<std::pair<std::string, const char*>> cases = {
      {"PRESET SELECT NAME \"VISE\"", "PRESET SELECT NAME, which only the control knows"},
      {"PRESET SELECT", "which only the control knows"},
      {"PRESET SELECT #3 PAL", "PRESET SELECT with PAL"},
      {"PRESET SELECT #1.5", "PRESET SELECT that is no row of a table"},
  };
  for (const auto& [preset, wanted] : cases) {
    const ReadText read = read_preset(preset);
    EXPECT_NE(read.error.find(wanted), std::string::npos) << preset << ": " << read.error;
  }
}

TEST(KlartextTools, MayBeCalledByName) {
  const ReadText read =
      read_klartext("1 TOOL CALL \"MILL D10\" Z S5000\n2 L X+1 Y+1 Z+1 R0 FMAX\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.tools, (std::vector<std::uint32_t>{900'000'001}));
}

}  // namespace
}  // namespace meridian::nc
