// SPDX-License-Identifier: Apache-2.0
// The sense in which a rotary word turns an axis that has no end of travel, worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

/// trunnion-bc, its C without end or not.
ClReaderOptions with_c(bool is_endless) {
  MachineModel model = shipped("trunnion-bc");
  for (JointSpec& joint : model.joints) {
    if (joint.name != "C") continue;
    joint.is_endless = is_endless;
    joint.limits.travel_min = -20;
    joint.limits.travel_max = 20;
  }
  return on(model);
}

/// By how much C turns on the cut that begins at motion `first`, deg, as the tool axis shows it.
double turn_deg(const ReadText& read, std::size_t first) {
  const auto motion = read.motion();
  double sum = 0;
  for (std::size_t n = first; n + 1 < motion.size(); ++n) {
    const auto from = axis(motion[n]), to = axis(motion[n + 1]);
    sum += std::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
  }
  return units::deg_from_rad(sum);
}

bool has_warning(const ReadText& read, std::string_view text) {
  return std::any_of(read.warnings.begin(), read.warnings.end(), [&](const auto& warning) {
    return warning.message.find(text) != std::string::npos;
  });
}

ReadText klartext_from_350(const std::string& head, const std::string& lines) {
  return read_klartext("1 TOOL CALL 1 Z S1000\n2 L X+0 Y+0 Z+50 B+30 C+350 R0 FMAX " + head +
                           "\n3 FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\n"
                           "4 L X+0 Y+0 Z+50 FMAX\n" +
                           lines,
                       klartext(with_c(true)));
}

TEST(RotarySense, IsTheShorterOneUnderM126OfKlartext) {
  const std::string turn = "5 L X+10 C+10 F500\n";
  const ReadText shorter = klartext_from_350("M126", turn);
  ASSERT_EQ(shorter.error, "");
  EXPECT_NEAR(std::abs(turn_deg(shorter, 0)), 20, 1e-6);
  EXPECT_FALSE(has_warning(shorter, "the shorter way"));
  const ReadText written = klartext_from_350("", turn);
  ASSERT_EQ(written.error, "");
  EXPECT_NEAR(std::abs(turn_deg(written, 0)), 340, 1e-6);
  EXPECT_TRUE(has_warning(written, "C turns by -340 deg in this block"));
  const ReadText ended = klartext_from_350("M126", "5 M127\n6 L X+10 C+10 F500\n");
  ASSERT_EQ(ended.error, "");
  EXPECT_NEAR(std::abs(turn_deg(ended, 0)), 340, 1e-6);
  // Where it has gone past 360 it stands within a turn for the words that follow.
  const ReadText on = klartext_from_350("M126", turn + "6 M127\n7 L X+20 C+40 F500\n");
  ASSERT_EQ(on.error, "");
  EXPECT_NEAR(std::abs(turn_deg(on, 0)), 50, 1e-6);
}

TEST(RotarySense, CountsWithinATurnBehindDcOfSiemens) {
  const std::string head = "G0 B30 C350\nTRAORI\nORIAXES\nG0 X0 Y0 Z5 B30 C350\n";
  const auto options = siemens(with_c(true));
  for (const auto& [lines, deg] : {std::pair{"G1 X10 C=DC(10) F100\nX20 C20\n", 30.0},
                                   {"G1 X10 C=DC(10) F100\nX20 C5\n", 15.0},
                                   {"G1 X10 C=ACN(340) F100\nX20 C-30\n", 20.0},
                                   {"G1 X10 C20 F100\n", 330.0}}) {
    const ReadText read = read_siemens(head + lines, options);
    ASSERT_EQ(read.error, "") << lines;
    EXPECT_NEAR(std::abs(turn_deg(read, 0)), deg, 1e-6) << lines;
  }
}

TEST(RotarySense, OfALongTurnIsFlaggedWhereTheControlMayRollOver) {
  const std::string head = "G0 B30. C350.\nG43.4 H1\nG0 X0. Y0. Z50. B30. C350.\n";
  const ReadText read = read_nc(head + "G1 X10. C10.\n", with_c(false));
  ASSERT_EQ(read.error, "");
  EXPECT_FALSE(has_warning(read, "rolls over")) << "this C has ends";
  const ReadText endless = read_nc(head + "G1 X10. C10.\n", with_c(true));
  ASSERT_EQ(endless.error, "");
  EXPECT_TRUE(has_warning(endless, "where it rolls over (parameter 1008)"));
  EXPECT_FALSE(has_warning(read_nc(head + "G1 X10. C180.\n", with_c(true)), "rolls over"));
}

}  // namespace
}  // namespace meridian::nc
