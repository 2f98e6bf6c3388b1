// SPDX-License-Identifier: Apache-2.0
// Canned cycles of Fanuc words.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

std::string holes(const std::string& body) {
  const ReadText read = read_nc("G0 X0. Y0. Z20.\n" + body);
  return read.error.empty() ? levels_of(read) : read.error;
}

TEST(NcCycles, DrillAndGoBackToWhereZStood) {
  EXPECT_EQ(holes("G81 X5. Z-10. R2.\nX9.\nG80\nG0 X0.\n"), "20r 2r -10f 20r 20r 2r -10f 20r 20r");
  EXPECT_EQ(read_nc("G0 X0. Y0. Z20.\nG81 X5. Z-10. R2.\nX9.\n").summary.holes, 2U);
}

TEST(NcCycles, GoBackToRUnderG99) {
  EXPECT_EQ(holes("G99 G81 X5. Z-10. R2.\nX9.\n"), "20r 2r -10f 2r 2r -10f 2r");
}

TEST(NcCycles, PeckAndBreakTheChip) {
  EXPECT_EQ(holes("G99 G83 Z-8. R0. Q5.\n"), "0r -5f 0r -4r -8f 0r");
  EXPECT_EQ(holes("G99 G73 Z-8. R0. Q5.\n"), "0r -5f -4r -8f 0r");
}

TEST(NcCycles, CountFromWhereTheToolStandsInG91) {
  EXPECT_EQ(holes("G91 G99 G81 X5. R-18. Z-12.\nX5.\n"), "20r 2r -10f 2r 2r -10f 2r");
}

TEST(NcCycles, DwellFeedOutAndStopTheSpindle) {
  const ReadText dwell = read_nc("G0 X0. Y0. Z20.\nG82 Z-1. R2. P250\n");
  EXPECT_DOUBLE_EQ(dwell.summary.dwell_time_s, 0.25);
  EXPECT_EQ(holes("G85 Z-10. R2.\n"), "2r -10f 2f 20r");
  const ReadText stop = read_nc("S100 M3\nG0 X0. Y0. Z20.\nG86 Z-10. R2.\n");
  EXPECT_EQ(stop.error, "");
  EXPECT_EQ(stop.summary.blocks_by_kind[static_cast<std::size_t>(BlockKind::kAuxiliary)], 3U);
}

TEST(NcCycles, AreOnlyStoredByK0) {
  EXPECT_EQ(holes("G81 Z-10. R2. K0\nX5.\n"), "20r 2r -10f 20r");
}

TEST(NcCycles, LieAlongTheMachinesZWhereThePartIsTurned) {
  MachineModel model = shipped("bench");
  config::place_workpiece(model, config::parse_frame("0,0,0,90,0,0"));
  const ReadText read = read_nc("G0 X0. Y0. Z20.\nG99 G81 Z-10. R2.\n", on(model));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_LT((tip(motion[2]) - Vector3(0, -10, 0)).norm(), kTiny);
  EXPECT_LT((axis(motion[2]) - Vector3(0, 1, 0)).norm(), kTiny);
}

TEST(NcCycles, AreRefusedByName) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"G84 Z-10. R2.", "G84: a canned cycle"},
      {"G76 Z-10. R2.", "G76: a canned cycle"},
      {"G81 Z-10.", "needs R and Z"},
      {"G81 Z5. R2.", "whose Z is not below its R"},
      {"G81 Z-9999999. R2.", "beyond 1e6 mm"},
      {"G83 Z-10. R2.", "needs their depth Q"},
      {"G81 Z-10. R2. K3", "K3 repeats of a cycle"},
      {"G18 G81 Z-10. R2.", "outside G17"},
      {"G43.5 G81 Z-10. R2.", "with tool-centre control"},
      {"G86 Z-10. R2.", "it does not turn"}};
  for (const auto& [line, says] : cases) {
    EXPECT_NE(holes(std::string(line) + "\n").find(says), std::string::npos)
        << line << ": " << holes(std::string(line) + "\n");
  }
}

TEST(NcCycle, StoredWithoutAHoleNamesNoPositionBeside) {
  const std::string head = "G43 H1\nG0 X0. Y0. Z20.\nG99 ";
  const ReadText read = read_nc(head + "G81 Z-5. R2. F100. K0\nX1. Y2.\nG80\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.holes, 1U);
  EXPECT_NE(read_nc(head + "G81 X1. Z-5. R2. F100. L0\nY2.\nG80\n").error.find("L0 beside X or Y"),
            std::string::npos);
}

}  // namespace
}  // namespace meridian::nc
