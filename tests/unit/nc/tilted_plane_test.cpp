// SPDX-License-Identifier: Apache-2.0
// G68.2, G53.1, G69 and G52: points in tilted planes, worked out by hand.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "meridian/units.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(TiltedPlane, PutsPointsAndAxisThroughItsFrame) {
  // About z by 90: x is +y. About that x by 45: z leans from +z towards +x.
  const ReadText read = read_nc(
      "G43 H1\nG68.2 X10. Y20. Z30. I90. J45. K0.\nG53.1\nG0 X1. Y0. Z5.\nG1 Z0.\nX2. Y3.\n"
      "G69\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  const Vector3 z(kHalfRoot, 0, kHalfRoot), x(0, 1, 0), y(-kHalfRoot, 0, kHalfRoot);
  const Vector3 zero(10, 20, 30);
  EXPECT_LT((tip(motion[0]) - (zero + x + 5 * z)).norm(), kTiny);
  EXPECT_LT((tip(motion[1]) - (zero + x)).norm(), kTiny);
  EXPECT_LT((tip(motion[2]) - (zero + 2 * x + 3 * y)).norm(), kTiny);
  for (const ClBlock& block : motion) EXPECT_LT((axis(block) - z).norm(), kTiny);
}

TEST(TiltedPlane, TurnsArcsAndHolesWithIt) {
  const ReadText read = read_nc(
      "G43 H1\nG68.2 X0. Y0. Z0. I0. J90. K0.\nG53.1\nG0 X10. Y0. Z5.\nG1 Z0.\nG3 X0. Y10. R10.\n"
      "G0 Z5.\nG99 G81 X3. Y4. Z-2. R1. F100.\nG80\nG69\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 8U);
  // y of the plane is z of the zero, z of it is -y.
  EXPECT_LT((tip(motion[2]) - Vector3(0, 0, 10)).norm(), kTiny);
  EXPECT_LT((to_vector(motion[2].normal) - Vector3(0, -1, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[6]) - Vector3(3, 2, 4)).norm(), kTiny) << "bottom of the hole";
  EXPECT_LT((axis(motion[6]) - Vector3(0, -1, 0)).norm(), kTiny);
}

/// z and x of the plane that these blocks define, and its origin, by three points in it.
struct Plane {
  Vector3 origin, x, z;
};
Plane plane_of(const std::string& blocks) {
  const ReadText read =
      read_nc("G43 H1\n" + blocks + "G53.1\nG0 X0. Y0. Z0.\nG1 X1.\nX0. Z1.\nG69\n");
  EXPECT_EQ(read.error, "") << blocks;
  const auto motion = read.motion();
  if (motion.size() != 3) return {};
  EXPECT_LT((axis(motion[1]) - (tip(motion[2]) - tip(motion[0]))).norm(), kTiny)
      << "the tool stands across it";
  return {tip(motion[0]), tip(motion[1]) - tip(motion[0]), tip(motion[2]) - tip(motion[0])};
}

TEST(TiltedPlane, OfOneRollPitchOrYawTurnsAboutThatAxis) {
  const Plane roll = plane_of("G68.2 P1 Q123 X1. Y2. Z3. I90. J0. K0.\n");
  EXPECT_LT((roll.origin - Vector3(1, 2, 3)).norm(), kTiny);
  EXPECT_LT((roll.x - Vector3(1, 0, 0)).norm() + (roll.z - Vector3(0, -1, 0)).norm(), kTiny);
  const Plane pitch = plane_of("G68.2 P1 X0. Y0. Z0. J90.\n");
  EXPECT_LT((pitch.x - Vector3(0, 0, -1)).norm() + (pitch.z - Vector3(1, 0, 0)).norm(), kTiny);
  const Plane yaw = plane_of("G68.2 P1 Q321. X0. Y0. Z0. K90.\n");
  EXPECT_LT((yaw.x - Vector3(0, 1, 0)).norm() + (yaw.z - Vector3(0, 0, 1)).norm(), kTiny);
}

TEST(TiltedPlane, OfThreePointsHasItsXFromTheFirstToTheSecond) {
  // x is straight up, the third point lies towards -x: z is -y.
  const Plane plane = plane_of(
      "G68.2 P2 Q0 X0. Y0. Z0. R0.\nG68.2 P2 Q1 X10. Y20. Z30.\nG68.2 P2 Q2 X10. Y20. Z80.\n"
      "G68.2 P2 Q3 X5. Y20. Z99.\n");
  EXPECT_LT((plane.origin - Vector3(10, 20, 30)).norm(), kTiny);
  EXPECT_LT((plane.x - Vector3(0, 0, 1)).norm() + (plane.z - Vector3(0, -1, 0)).norm(), kTiny);
}

TEST(TiltedPlane, OfTwoVectorsHasThemAsItsXAndZ) {
  const Plane plane = plane_of("G68.2 P3 Q1 X1. Y2. Z3. I0. J2. K0.\nG68.2 P3 Q2 I5. J0. K5.\n");
  EXPECT_LT((plane.origin - Vector3(1, 2, 3)).norm(), kTiny);
  EXPECT_LT((plane.x - Vector3(0, 1, 0)).norm(), kTiny);
  EXPECT_LT((plane.z - Vector3(kHalfRoot, 0, kHalfRoot)).norm(), kTiny);
}

TEST(TiltedPlane, OfSeveralBlocksIsRefusedWhereItIsNotWhole) {
  const std::string first = "G68.2 P2 Q1 X0. Y0. Z0.\n", second = "G68.2 P2 Q2 X9. Y0. Z0.\n";
  for (const auto& [body, says] : std::vector<std::pair<std::string, const char*>>{
           {first + "G53.1\n", "G68.2 P2 without its Q2"},
           {first + second + "G0 X0. Y0. Z0.\n", "G68.2 P2 without its Q3"},
           {first + "G68.2 X0. Y0. Z0. I0. J0. K0.\n", "without its Q2"},
           {first + "G68.2 P3 Q2 I0. J0. K1.\n", "out of its order"},
           {second, "out of its order"},
           {first + "G68.2 P2 Q3 X0. Y9. Z0.\n", "out of its order"},
           {"G68.2 P2 Q0 X5. Y0. Z0.\n", "Q0 with a shift"},
           {"G68.2 P2 X5. Y0. Z0.\n", "needs Q0 to Q3"},
           {first + second + "G68.2 P2 Q3 X4. Y0. Z0.\n", "lie on a line"},
           {"G68.2 P3 Q1 X0. Y0. Z0. I1. J0. K0.\nG68.2 P3 Q2 I1. J0. K1.\n",
            "do not stand square"},
           {"G68.2 P3 Q1 X0. Y0. Z0.\n", "no direction"},
           {"G68.2 P1 Q122 X0. Y0. Z0. I9.\n", "no order of three axes"},
           {"G68.2 Q123 X0. Y0. Z0. I9. J0. K0.\n", "other axes than Z X Z"},
           {"G68.2 X0. Y0. Z0. I9. J0. K0. R5.\n", "G68.2 with R"}}) {
    EXPECT_NE(read_nc("G43 H1\n" + body).error.find(says), std::string::npos)
        << body << read_nc("G43 H1\n" + body).error;
  }
  EXPECT_EQ(read_nc("G43 H1\n" + first + "G69\nG0 X0. Y0. Z0.\nG1 X1.\n").error, "")
      << "G69 ends it";
}

TEST(TiltedPlane, IsNotCutInBeforeTheToolStandsAcrossIt) {
  const ReadText read = read_nc("G43 H1\nG68.2 X0. Y0. Z0. I0. J30. K0.\nG0 X0. Y0. Z5.\nG1 Z0.\n");
  EXPECT_EQ(read.error_line, 7U) << read.error;
  EXPECT_NE(read.error.find("does not stand across"), std::string::npos) << read.error;
}

TEST(TiltedPlane, KnowsByTheMachineThatRotaryWordsStandAcrossIt) {
  const std::string body =
      "G43 H1\nG0 A-30. C0.\nG68.2 X0. Y0. Z0. I0. J30. K0.\nG0 X0. Y0. Z5.\nG1 Z0.\n";
  const ReadText there = read_nc(body, on(shipped("trunnion-ac")));
  ASSERT_EQ(there.error, "");
  EXPECT_EQ(there.motion().size(), 2U);
  EXPECT_NE(read_nc(body).error.find("--machine FILE"), std::string::npos) << "no machine";
  std::string wrong = body;
  wrong.replace(wrong.find("A-30."), 5, "A-31.");
  EXPECT_NE(read_nc(wrong, on(shipped("trunnion-ac"))).error.find("does not stand across"),
            std::string::npos);
}

TEST(TiltedPlane, LeavesTheRotaryAxesWhereNoWordSaysOtherwise) {
  const std::string head = "G43 H1\nG68.2 X0. Y0. Z0. I0. J30. K0.\nG53.1\nG0 X0. Y0. Z5.\nG69\n";
  EXPECT_NE(read_nc(head + "G0 X1. Y1. Z9.\nG1 Z0.\n").error.find("says where they stand"),
            std::string::npos);
  EXPECT_NE(read_nc(head + "G43.4 H1\nG1 X1. Y1. Z9.\n", on(shipped("trunnion-ac")))
                .error.find("no word says to where"),
            std::string::npos);
  EXPECT_EQ(read_nc(head + "G0 A0. C0.\nG0 X1. Y1. Z9.\nG1 Z0.\n").error, "");
}

TEST(TiltedPlane, HoldsUnderToolCentreControlToo) {
  const ReadText read =
      read_nc("G68.2 X1. Y2. Z3. I90. J0. K0.\nG0 A0. C0.\nG43.4 H1\nG0 X5. Y0. Z0.\nG1 X6. A30.\n",
              on(shipped("trunnion-ac")));
  ASSERT_EQ(read.error, "");
  EXPECT_LT((tip(read.motion()[0]) - Vector3(1, 7, 3)).norm(), kTiny);
  EXPECT_LT((tip(read.motion().back()) - Vector3(1, 8, 3)).norm(), kTiny);
  EXPECT_NEAR(axis(read.motion().back())[2], std::cos(units::rad_from_deg(30)), kTiny)
      << "the axis is that of the rotary words";
}

TEST(TiltedPlane, RefusesWhatItCannotRead) {
  for (const auto& [body, says] : std::vector<std::pair<const char*, const char*>>{
           {"G91 G68.2 X0. Y0. Z0. I0. J0. K0.\n", "under G91"},
           {"G43.5 H1\nG68.2 X0. Y0. Z0. I0. J0. K0.\n", "tool-centre control is on"},
           {"G68.2 X0. Y0. Z0. I0. J9. K0.\nG43.5 H1\nG0 X0. Y0. Z0. I0. J0. K1.\n",
            "G43.5 in a tilted plane"},
           {"G68.2 X0. Y0. Z0. I0. J9. K0.\nG53.1 X5.\n", "G53.6 with words beside P"},
           {"G68.2 X0. Y0. Z0. I0. J9. K0.\nG52 X5.\n", "G52 in a tilted plane"}}) {
    EXPECT_NE(read_nc(body).error.find(says), std::string::npos) << body << read_nc(body).error;
  }
}

/// What a trunnion about y with a table about z, at B and C in degrees, does to a point of the
/// part.
Vector3 on_table(double b_deg, double c_deg, const Vector3& machine) {
  const double b = units::rad_from_deg(b_deg), c = units::rad_from_deg(c_deg);
  const Eigen::Matrix3d table =
      (Eigen::AngleAxisd(b, Vector3::UnitY()) * Eigen::AngleAxisd(c, Vector3::UnitZ()))
          .toRotationMatrix();
  return table.transpose() * machine;
}

TEST(DynamicOffset, ReadsPointsAlongTheMachinesAxesFromTheZeroOnTheTable) {
  const MachineModel machine = shipped("trunnion-bc");
  const ReadText read = read_nc(
      "G0 B-30. C90.\nG254\nG0 X10. Y5.\nG43 H1 Z20.\nG1 Z2.\nX12.\nG0 Z50.\n"
      "G0 X1. Y2. Z60. B20. C0.\nG1 Z3.\nG255\nG0 B0. C0.\nG0 X0. Y0. Z90.\nG1 Z80.\n",
      on(machine));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 8U);
  const Vector3 first = on_table(-30, 90, {10, 5, 20}), last = on_table(20, 0, {1, 2, 3});
  EXPECT_LT((tip(motion[0]) - first).norm(), kTiny) << tip(motion[0]).transpose();
  EXPECT_LT((axis(motion[0]) - on_table(-30, 90, Vector3::UnitZ())).norm(), kTiny);
  EXPECT_LT((tip(motion[5]) - last).norm(), kTiny);
  EXPECT_LT((axis(motion[5]) - on_table(20, 0, Vector3::UnitZ())).norm(), kTiny);
  EXPECT_EQ(tip(motion[7]), Vector3(0, 0, 80)) << "G255 ends it";
  EXPECT_TRUE(read.warned_of("the table turns under G254"));
}

TEST(DynamicOffset, DoesNotKnowWhereAnAxisIsThatTheTurningBlockLeavesOut) {
  const ReadText read = read_nc("G43 H1\nG254\nG0 X0. Y0. Z9.\nG0 X1. Y1. B20.\nG1 X2.\n",
                                on(shipped("trunnion-bc")));
  EXPECT_EQ(read.error_line, 8U) << read.error;
  EXPECT_NE(read.error.find("is not known here"), std::string::npos) << read.error;
}

TEST(DynamicOffset, IsRefusedWhereItsPointsAreNotThoseOfTheTip) {
  const auto trunnion = on(shipped("trunnion-bc"));
  for (const auto& [body, says] : std::vector<std::pair<const char*, const char*>>{
           {"G43 H1\nG254\nG0 X0. Y0. Z9.\nG1 X1. B20.\n", "a cut in which rotary axes turn"},
           {"G254\nG43.4 H1\n", "tool-centre control under G254"},
           {"G43.4 H1\nG254\n", "tool-centre control is on"},
           {"G254\nG68.2 X0. Y0. Z0. I0. J9. K0.\n", "G68.2 under G254"},
           {"G68.2 X0. Y0. Z0. I0. J9. K0.\nG254\n", "G254 in a tilted plane"},
           {"G43 H1\nG254\nG0 X0. Y0. Z9.\nG91 G28 B0.\n", "rotary words under G254"},
           {"G254\nG91 G0 B20.\n", "G91"}}) {
    EXPECT_NE(read_nc(body, trunnion).error.find(says), std::string::npos)
        << body << read_nc(body, trunnion).error;
  }
  EXPECT_NE(read_nc("G254\n").error.find("--machine FILE"), std::string::npos);
  EXPECT_NE(read_nc("G0 B20. C0.\nG254\n", on(shipped("fork-cb"))).error.find("turn the tool"),
            std::string::npos);
}

TEST(LocalZero, MovesThePointsBehindIt) {
  const ReadText read =
      read_nc("G43 H1\nG0 X1. Y1. Z1.\nG52 X10. Z5.\nG1 X1.\nG91 Z1.\nG90 G52 X0. Z0.\nX1. Z1.\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_EQ(tip(motion[1]), Vector3(11, 1, 1));
  EXPECT_EQ(tip(motion[2]), Vector3(11, 1, 2));
  EXPECT_EQ(tip(motion[3]), Vector3(1, 1, 1));
  EXPECT_TRUE(read.warned_of("changes its frame"));
}

}  // namespace
}  // namespace meridian::nc
