// SPDX-License-Identifier: Apache-2.0
// Rotary words: the tool axis that they give, and blocks that are cut to follow it.
#include "service/programs/nc/words/turn.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "meridian/units.hpp"
#include "service/programs/cl/cl_points.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

double angle(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST(NcTurn, RotaryWordsGiveTheAxisThatTheMachineGives) {
  // The spindle stands; the table turns by B, and the axis turns the other way in the part.
  const ReadText read =
      read_nc("G0 B0. C0.\nG43.4 H1\nG0 X0. Y0. Z50. B30. C0.\n", on(shipped("trunnion-bc")));
  ASSERT_EQ(read.error, "");
  const Vector3 k = axis(read.motion().at(0));
  EXPECT_NEAR(k[2], std::cos(units::rad_from_deg(30)), kTiny);
  EXPECT_NEAR(std::abs(k[0]), 0.5, kTiny);
}

TEST(NcTurn, PointsLieAlongTheMachinesAxesWhereThePartIsTurned) {
  MachineModel model = shipped("bench");
  config::place_workpiece(model, config::parse_frame("10,20,30,0,0,90"));
  const ReadText read = read_nc("G43.5 H1\nG0 X1. Y2. Z3. I1. J0. K0.\n", on(model));
  ASSERT_EQ(read.error, "");
  const ClBlock block = read.motion().at(0);
  EXPECT_LT((tip(block) - Vector3(2, -1, 3)).norm(), kTiny);
  EXPECT_LT((axis(block) - Vector3(0, -1, 0)).norm(), kTiny);
}

TEST(NcTurn, ABlockIsCutSoThatTheAxisFollowsTheJoints) {
  const MachineModel model = shipped("trunnion-ac");
  const ReadText read =
      read_nc("G0 A30. C0.\nG43.4 H1\nG0 X0. Y0. Z50.\nG1 X90. C90.\n", on(model));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_GT(motion.size(), 5U);
  EXPECT_EQ(read.summary.nc.turned_blocks, 1U);
  EXPECT_EQ(read.summary.nc.turned_pieces, motion.size() - 1);
  EXPECT_NE(to_text(read.summary).find("rotary words   1 blocks cut into"), std::string::npos);
  const MachineAxes axes(model, ToolTable());
  const std::size_t pieces = motion.size() - 1;
  for (std::size_t n = 0; n < pieces; ++n) {
    const double share = (static_cast<double>(n) + 0.5) / static_cast<double>(pieces);
    const Vector3 true_axis = axes.axis({{"A", 30.0}, {"C", 90 * share}});
    const Vector3 middle = cl::turn_towards(axis(motion[n]), axis(motion[n + 1]), 0.5);
    EXPECT_LE(angle(middle, true_axis), model.tolerances.axis_rad);
    EXPECT_NEAR(motion[n + 1].tip_mm[0],
                90.0 * static_cast<double>(n + 1) / static_cast<double>(pieces), kTiny);
  }
}

TEST(NcTurn, ATurnOverThePoleGoesTheWayOfTheJoints) {
  // C turns by 180 degrees with A tilted little: the axis goes round the pole, not over it.
  const ReadText read =
      read_nc("G0 A1. C0.\nG43.4 H1\nG0 X0. Y0. Z50.\nG1 X1. C180.\n", on(shipped("trunnion-ac")));
  const auto motion = read.motion();
  ASSERT_GT(motion.size(), 4U);
  for (const ClBlock& block : motion) {
    EXPECT_NEAR(axis(block)[2], std::cos(units::rad_from_deg(1)), 1e-6);
  }
}

TEST(NcTurn, AWholeTurnIsNotLost) {
  const ReadText read =
      read_nc("G0 A30. C0.\nG43.4 H1\nG0 X0. Y0. Z50.\nG1 X1. C360.\n", on(shipped("trunnion-ac")));
  EXPECT_GT(read.motion().size(), 12U);
}

TEST(NcTurn, ATurnThatMovesNoAxisIsNotCut) {
  const MachineAxes axes(shipped("trunnion-ac"), ToolTable());
  const double tolerance = axes.axis_tolerance_rad();
  EXPECT_EQ(pieces_of_turn(axes, {{"A", 0.0}, {"C", 0.0}}, {{"A", 0.0}, {"C", 90.0}}, tolerance),
            1);
  EXPECT_EQ(pieces_of_turn(axes, {{"A", 0.0}}, {{"A", 40.0}}, tolerance), 1);
}

TEST(NcTurn, InverseTimeIsSharedByThePieces) {
  const ReadText read = read_nc("G0 A30. C0.\nG43.4 H1\nG0 X0. Y0. Z50.\nG93 G1 X90. C90. F60.\n",
                                on(shipped("trunnion-ac")));
  const auto motion = read.motion();
  ASSERT_GT(motion.size(), 2U);
  double time_s = 0;
  for (std::size_t n = 1; n < motion.size(); ++n) time_s += 1 / motion[n].feed;
  EXPECT_NEAR(time_s, 1, kTiny);
}

TEST(NcTurn, RefusesMoreThanAHundredTurns) {
  const ReadText read = read_nc("G0 A30. C0.\nG43.4 H1\nG0 X0. Y0. Z50.\nG1 X1. C99999.\n",
                                on(shipped("trunnion-ac")));
  EXPECT_NE(read.error.find("more than a hundred turns"), std::string::npos);
}

/// A program of each language: the tool tilted by vectors, tool-centre control off, `between`, a
/// cut.
std::vector<ReadText> cuts_after_vectors(const std::string& tilt, const std::string& between) {
  const auto options = on(shipped("trunnion-ac"));
  const std::string numbers = tilt == "0" ? " I0. J0. K1." : " I0.6 J0. K0.8";
  return {read_nc("G43.5 H1\nG0 X0. Y0. Z9. I0. J0. K1.\nG1 X1." + numbers + "\nG49\nG43 H1\nG0" +
                      between + " Z9.\nX0. Y0. Z5.\nG1 X5.\n",
                  options),
          read_siemens("TRAORI\nG0 X0 Y0 Z9 A3=0 B3=0 C3=1\nG1 X1 A3=" + tilt +
                           " C3=1\nTRAFOOF\nG0" + between + " Z9\nX0 Y0 Z5\nG1 X5\n",
                       siemens(options)),
          read_klartext("1 M128\n2 LN X+0 Y+0 Z+9 TX+0 TY+0 TZ+1 FMAX\n3 LN X+1 TX+" + tilt +
                            " TZ+1 F600\n4 M129\n5 L" + between +
                            " Z+9 FMAX\n6 L X+0 Y+0 Z+5 FMAX\n7 L X+5 F600\n",
                        klartext(options))};
}

TEST(Turns, ByVectorsLeaveTheRotaryAxesWhereNoWordSays) {
  for (const ReadText& read : cuts_after_vectors("0.6", "")) {
    EXPECT_NE(read.error.find("no word says where they stand"), std::string::npos)
        << read.error << read.summary.dialect;
  }
  for (const ReadText& read : cuts_after_vectors("0.6", " C0")) {
    EXPECT_NE(read.error.find("no word says where they stand"), std::string::npos)
        << read.error << read.summary.dialect;
  }
  for (const ReadText& read : cuts_after_vectors("0.6", " A0 C0")) EXPECT_EQ(read.error, "");
  for (const ReadText& read : cuts_after_vectors("0", "")) EXPECT_EQ(read.error, "");
}

TEST(Turns, ByOneRotaryWordAfterVectorsAreRefused) {
  const ReadText read = read_siemens(
      "G0 A0 C0\nTRAORI\nG0 X0 Y0 Z9 A3=0 B3=0 C3=1\nG1 X1 A3=0.6 C3=0.8\nG1 X2 C90\nTRAFOOF\n",
      siemens(on(shipped("trunnion-ac"))));
  EXPECT_EQ(read.error_line, 8U) << read.error;
  EXPECT_NE(read.error.find("no word says to where"), std::string::npos) << read.error;
}

}  // namespace
}  // namespace meridian::nc
