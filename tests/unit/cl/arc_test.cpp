// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/arc.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kExact_mm = 1e-12;  // 100 mm * eps = 2e-14, 50x margin

/// Where the arc ends if it is run from `begin`.
Vector3 run(const Arc& arc, const Vector3& begin, const Vector3& end) {
  const Vector3 x = begin - arc.centre;
  const Vector3 y = arc.normal.cross(x);
  return arc.centre + std::cos(arc.sweep_rad) * x + std::sin(arc.sweep_rad) * y +
         arc.normal * arc.normal.dot(end - begin);
}

TEST(Arc, TurnsRightHandedAboutItsNormal) {
  const Arc up = solve_arc({10, 0, 0}, {0, 10, 0}, {0, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(up.sweep_rad, kPi / 2, 1e-15);
  const Arc down = solve_arc({10, 0, 0}, {0, 10, 0}, {0, 0, 0}, {0, 0, -1});
  EXPECT_NEAR(down.sweep_rad, 3 * kPi / 2, 1e-15);
}

TEST(Arc, IsAFullCircleWhereItEndsAtItsBegin) {
  const Arc arc = solve_arc({10, 0, 0}, {10, 0, 0}, {0, 0, 0}, {0, 0, -1});
  EXPECT_EQ(arc.sweep_rad, 2 * kPi);
}

TEST(Arc, RisesAlongItsNormal) {
  const Arc arc = solve_arc({10, 0, 1}, {0, 10, 4}, {0, 0, 77}, {0, 0, 1});
  EXPECT_EQ(arc.status, Arc::Status::kOk);
  EXPECT_EQ(arc.centre[2], 1);
  EXPECT_LT((run(arc, {10, 0, 1}, {0, 10, 4}) - Vector3{0, 10, 4}).norm(), kExact_mm);
}

TEST(Arc, PassesThroughBothEndsAlthoughTheFileRoundsThem) {
  std::mt19937_64 random(11);  // seed 11
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 5000; ++i) {
    const Vector3 normal = Vector3{unit(random), unit(random), unit(random)}.normalized();
    const Vector3 centre = 100 * Vector3{unit(random), unit(random), unit(random)};
    const Vector3 arm = normal.unitOrthogonal() * (5 + 20 * (unit(random) + 1));
    const double sweep = 0.02 + (unit(random) + 1) * 0.98 * kPi;
    const Vector3 begin = centre + arm;
    const Vector3 rounding = 1e-4 * Vector3{unit(random), unit(random), unit(random)};
    const Vector3 end = centre + Eigen::AngleAxisd(sweep, normal) * arm + rounding;
    const Arc arc = solve_arc(begin, end, centre, normal);
    ASSERT_EQ(arc.status, Arc::Status::kOk);
    ASSERT_LT((run(arc, begin, end) - arc.end).norm(), kExact_mm) << i;
    ASSERT_LT((arc.end - end).norm(), 2e-4);
    ASSERT_TRUE(sweep >= kPi || arc.end == end);
    ASSERT_NEAR(arc.sweep_rad, sweep, 1e-4 / arm.norm() * 20);
    // The middle of the arc stays within a few times the rounding of what was written.
    const Vector3 meant = centre + Eigen::AngleAxisd(sweep / 2, normal) * arm;
    const Vector3 x = begin - arc.centre;
    const Vector3 middle = arc.centre + std::cos(arc.sweep_rad / 2) * x +
                           std::sin(arc.sweep_rad / 2) * arc.normal.cross(x) +
                           arc.normal * arc.normal.dot(end - begin) / 2;
    ASSERT_LT((middle - meant).norm(), 2e-3) << sweep;
  }
}

TEST(Arc, IsRefusedOffItsCircleAndWithoutRadius) {
  EXPECT_EQ(solve_arc({10, 0, 0}, {0, 10.02, 0}, {0, 0, 0}, {0, 0, 1}).status,
            Arc::Status::kNotOneCircle);
  EXPECT_EQ(solve_arc({10, 0, 0}, {0, 10.009, 0}, {0, 0, 0}, {0, 0, 1}).status, Arc::Status::kOk);
  EXPECT_EQ(solve_arc({0, 0, 5}, {0, 10, 0}, {0, 0, 0}, {0, 0, 1}).status, Arc::Status::kNoRadius);
  EXPECT_EQ(solve_arc({10, 0, 0}, {0, 10, 0}, {0, 0, 0}, {0, 0, 0}).status, Arc::Status::kNoRadius);
}

TEST(Circle, WithSixNumbersTurnsRightHanded) {
  const auto m = read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,10,0\n").motion();
  ASSERT_EQ(m.size(), 2U);
  EXPECT_TRUE(m[1].is_arc);
  EXPECT_NEAR(m[1].sweep_rad, kPi / 2, 1e-15);
  EXPECT_EQ(m[1].normal, (Array3{0, 0, 1}));
  EXPECT_EQ(m[1].line, 5U);
}

TEST(Circle, WithSevenNumbersTurnsRightHandedAndClosesFullCircles) {
  const auto read = read_body(
      "GOTO / 50.29 , .0 , 28.86\nCIRCLE / .0 , .0 , 28.86 $\n.0 , .0 , -1.0 , 50.29\n"
      "GOTO / 50.29 , .0 , 28.86\nGOTO/49,0,28.86\nCIRCLE/0,0,28.86,0,0,-1,49\nGOTO/0,-49,28.86\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  EXPECT_EQ(m.at(1).sweep_rad, 2 * kPi);
  EXPECT_EQ(m[1].normal, (Array3{0, 0, -1}));
  EXPECT_NEAR(m.at(3).sweep_rad, kPi / 2, 1e-15);
  EXPECT_EQ(read.summary.full_circles, 1U);
  EXPECT_EQ(read.summary.arcs, 2U);
}

TEST(Circle, WithElevenNumbersTurnsClockwise) {
  // Along +y on the left of the centre, then normal +z: clockwise, as NX documents it.
  const auto m = read_body(
                     "GOTO/5,8,28\nGOTO/5,25,28\n"
                     "CIRCLE/10,25,28,0,0,1,5,0.0020,0.5,10.0,0.0\nGOTO/10,30,28\n")
                     .motion();
  EXPECT_EQ(m.at(2).normal, (Array3{0, 0, -1}));
  EXPECT_NEAR(m[2].sweep_rad, kPi / 2, 1e-15);
}

TEST(Circle, TakesNormalsOfMinusZero) {
  const auto m =
      read_body(
          "GOTO/5.6943646,-2.1512949,28.0\nCIRCLE/1.5623138,0.6640481,28.0,-0.0000000,"
          "-0.0000000,-1.0000000,5.0,0.0020000,0.5,10.0,0.0\nGOTO/6.1638998,2.6199127,28.0\n")
          .motion();
  EXPECT_EQ(m.at(1).normal, (Array3{0, 0, 1}));
  EXPECT_LT(m[1].sweep_rad, 1.01);
}

TEST(Circle, OfAHelixOfSeveralTurnsBecomesOneArcPerTurn) {
  const auto read =
      read_body("GOTO/-1,0,0\nCIRCLE/0,0,-2,0,0,-1,1,.002,.5,1,0,TIMES,2\nGOTO/-1,0,-2.5\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_EQ(m[1].sweep_rad, 2 * kPi);
  EXPECT_DOUBLE_EQ(m[1].tip_mm[2], -1.25);
  EXPECT_DOUBLE_EQ(m[2].tip_mm[2], -2.5);
}

/// TIMES,n are n - 1 whole turns and the arc to the end: here 360 and 270 of 630 degrees.
TEST(Circle, OfAHelixThatDoesNotEndAboveItsBeginHasAPartialTurnAtItsEnd) {
  const auto read =
      read_body("GOTO/-1,0,0\nCIRCLE/0,0,0,0,0,-1,1,.002,.5,1,0,TIMES,2\nGOTO/0,1,-6.3\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_EQ(m[1].sweep_rad, 2 * kPi);
  EXPECT_NEAR(m[1].tip_mm[0], -1, 1e-12);
  EXPECT_NEAR(m[1].tip_mm[2], -3.6, 1e-12);
  EXPECT_NEAR(m[2].sweep_rad, 1.5 * kPi, 1e-12);
  EXPECT_EQ(m[2].tip_mm, (Array3{0, 1, -6.3}));
  EXPECT_NEAR(m[2].centre_mm[2], -3.6, 1e-12);
  EXPECT_NEAR(read.summary.cut_length_mm, std::hypot(3.5 * kPi, 6.3), 1e-9);
}

TEST(Circle, OfSeveralTurnsMayStayInItsPlaneAndRise) {
  const auto flat = read_body("GOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5,TIMES,3\nGOTO/5,0,0\n").motion();
  ASSERT_EQ(flat.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(flat[i].sweep_rad, 2 * kPi);
  const auto rising = read_body("GOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5,TIMES,2\nGOTO/-5,0,3\n").motion();
  ASSERT_EQ(rising.size(), 3U);
  EXPECT_NEAR(rising[1].tip_mm[2], 2, 1e-12);
  EXPECT_NEAR(rising[2].sweep_rad, kPi, 1e-12);
}

TEST(Circle, OfAHelixInInverseTimeTakesTheTimeOfOneBlock) {
  const auto m =
      read_body("FEDRAT/INVERS,2\nGOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5,TIMES,2\nGOTO/-5,0,3\n")
          .motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_NEAR(1 / m[1].feed + 1 / m[2].feed, 30, 1e-9);
  EXPECT_NEAR(m[2].feed / m[1].feed, 2, 1e-9);
}

TEST(Circle, WithANormalBeyondAllNumbersIsRefused) {
  EXPECT_NE(read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1e308,10\nGOTO/0,10,0\n").error, "");
}

TEST(Circle, OfMovarcTurnsByTheSignOfItsSweep) {
  const auto left = read_body("GOTO/10,0,0\nMOVARC/0,0,0,0,0,1,10,ANGLE,90\nGOTO/0,10,0\n");
  ASSERT_EQ(left.error, "");
  EXPECT_NEAR(left.motion().at(1).sweep_rad, kPi / 2, 1e-12);
  const auto right = read_body("GOTO/10,0,0\nMOVARC/0,0,0,0,0,1,10,ANGLE,-270\nGOTO/0,10,0\n");
  ASSERT_EQ(right.error, "");
  EXPECT_NEAR(right.motion().at(1).sweep_rad, 1.5 * kPi, 1e-12);
  EXPECT_NE(read_body("GOTO/10,0,0\nMOVARC/0,0,0,0,0,1,10,ANGLE,80\nGOTO/0,10,0\n")
                .error.find("its end lies elsewhere"),
            std::string::npos);
}

TEST(ReadArc, MovarcByKeywordsTurnsRightHandedAboutItsAxis) {
  const auto read = read_body(
      "GOTO/10,0,0\nARCSLP/ 2\nMOVARC/ CENTER, 0, 0, 0, AXIS, 0, 0, -1, RADIUS, 10\n"
      "GOTO/ 0, 10, 2\n");
  ASSERT_EQ(read.error, "");
  EXPECT_NEAR(read.motion().at(1).sweep_rad, 1.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(read.motion()[1].normal[2], -1);
  for (const char* const form :
       {"MOVARC/ CENTER, 0, 0, 0, AXIS, 0, 0, 1, RADIUS, 10, TIMES, 2",
        "MOVARC/ CENTER, 0, 0, 0, RADIUS, 10, AXIS, 0, 0, 1", "MOVARC/ 0, 0, 0, 0, 0, 1, 10"}) {
    EXPECT_NE(
        read_body(std::string("GOTO/10,0,0\n") + form + "\nGOTO/0,10,0\n").error.find("MOVARC"),
        std::string::npos)
        << form;
  }
}

/// Creo writes the points of an arc as a list: only the last one ends it.
TEST(Circle, OfCreoEndsAtTheLastPointOfItsList) {
  const auto read = read_body(
      "GOTO / 10.0, 0.0, 0.0\nCIRCLE / 0.0, 0.0, 0.0,  $\n0.0, 0.0, 1.0, 10.0\n"
      "GOTO / 7.0710678119, 7.0710678119, 0.0\n0.0, 10.0, 0.0\n-10.0, 0.0, 0.0\nGOTO/-10,5,0\n",
      written_by(Dialect::kCreo));
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_NEAR(m[1].sweep_rad, kPi, 1e-9);
  EXPECT_EQ(m[1].tip_mm, (Array3{-10, 0, 0}));
  EXPECT_EQ(read.summary.listed_points, 2U);
  EXPECT_EQ(read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n-10,0,0\n",
                      written_by(Dialect::kCreo))
                .motion()
                .size(),
            2U);  // at the end of the file too
}

TEST(Circle, WithFourNumbersTakesItsSenseFromIndirv) {
  const auto left = read_body("GOTO/10,0,0\nINDIRV/0,1,0\nCIRCLE/0,0,0,10\nGOTO/0,10,0\n").motion();
  EXPECT_NEAR(left.at(1).sweep_rad, kPi / 2, 1e-15);
  const auto right =
      read_body("GOTO/10,0,0\nINDIRV/0,-1,0\nCIRCLE/0,0,0,$\n10\nGOTO/0,10,0\n").motion();
  EXPECT_NEAR(right.at(1).sweep_rad, 3 * kPi / 2, 1e-15);
  EXPECT_NE(read_body("GOTO/10,0,0\nCIRCLE/0,0,0,10\nGOTO/0,10,0\n")
                .error.find("does not give its sense"),
            std::string::npos);
}

TEST(Circle, OfCatiaComesByTlon) {
  const auto flat = read_body(
      "GOTO  / 10.0,0.0,5.0\nAUTOPS\nINDIRV/ 0.0,1.0,0.0\n"
      "TLON,GOFWD/ (CIRCLE/ 0.0,0.0,5.0,$\n10.0),ON,2,INTOF,$\n(LINE/ "
      "0.0,0.0,5.0,-10.0,0.0,5.0)\n");
  ASSERT_EQ(flat.error, "");
  EXPECT_NEAR(flat.motion().at(1).sweep_rad, kPi, 1e-15);
  EXPECT_EQ(flat.motion()[1].tip_mm, (Array3{-10, 0, 5}));
  const auto inclined = read_body(
      "GOTO/ 10.0,0.0,0.0\nPSIS/(PLANE/(POINT/ 10.0,0.0,0.0),PERPTO,$\n(VECTOR/ 0.0,-1.0,0.0))\n"
      "INDIRV/ 0.0,0.0,1.0\nTLON,GOFWD/ (CYLNDR / 0.0,0.0,0.0,$\n0.0,-1.0,0.0,10.0), ON,$\n"
      "(PLANE/PERPTO,$\n(PLANE/(POINT/0.0,0.0,0.0),PERPTO,$\n(VECTOR/0.0,-1.0,0.0)),$\n"
      "(POINT/0.0,0.0,0.0),$\n(POINT/0.0,0.0,10.0))\n");
  ASSERT_EQ(inclined.error, "");
  EXPECT_NEAR(inclined.motion().at(1).sweep_rad, kPi / 2, 1e-15);
  EXPECT_NEAR(inclined.motion()[1].normal[1], -1, 1e-15);
}

TEST(Circle, TurnsTheAxisWhereItsGotoGivesOne) {
  const auto m = read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0,0,.6,.8\n").motion();
  EXPECT_NEAR(m.at(1).axis[1], .6, 1e-15);
}

TEST(Circle, IsRefusedWhereItContradictsItself) {
  const char* const files[] = {
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,12\nGOTO/0,10,0\n",    // radius
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,11,0\n",    // end off the circle
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,0,10\nGOTO/0,10,0\n",    // no plane
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,1\nGOTO/0,10,0\n",  // 8 numbers
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,X\nGOTO/0,10,0\n",     // a word
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nCIRCLE/0,0,0,0,0,1,10\n",
      "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\n",  // no GOTO
      "CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n",  // no begin
  };
  for (const char* const file : files) EXPECT_NE(read_body(file).error, "") << file;
}

TEST(Circle, IsRefusedWhereThePathEndsOrTheToolChangesBeforeItsGoto) {
  for (const char* word :
       {"END-OF-PATH", "TOOL PATH/B,TOOL,T", "LOADTL/2", "LOAD/TOOL,2", "FROM/0,10,0",
        "UNITS/INCHES", "TRNTYP/WORLD", "MSYS/0,0,0,1,0,0,0,1,0"}) {
    const auto read = read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\n" + std::string(word) +
                                "\nGOTO/0,10,0\nEND-OF-PATH\n");
    EXPECT_EQ(read.error_line, 5U) << word << read.error;
    EXPECT_NE(read.error.find("between CIRCLE and"), std::string::npos) << read.error;
    EXPECT_EQ(read.blocks.size(), 1U) << word;
  }
  EXPECT_EQ(read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nFEDRAT/90\nPAINT/COLOR,1\nGOTO/0,10,0\n")
                .error,
            "");
}

TEST(Circle, WhoseEndsAreNearlyOnePointIsReadByItsSenseAndFlagged) {
  const auto circle = [](const char* end) {
    return read_body("GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/" + std::string(end) + ",0\n");
  };
  const auto shorter = circle("10,0.0001");
  EXPECT_NEAR(shorter.motion().at(1).sweep_rad, 1e-5, 1e-9);
  EXPECT_TRUE(shorter.warned_of("0.0001 mm apart"));
  const auto longer = circle("10,-0.0001");
  EXPECT_NEAR(longer.motion().at(1).sweep_rad, 2 * kPi - 1e-5, 1e-9);
  EXPECT_TRUE(longer.warned_of("0.0001 mm apart"));
  EXPECT_TRUE(circle("10,0.009").warned_of("apart"));
  EXPECT_FALSE(circle("10,0.011").warned_of("apart"));
  EXPECT_TRUE(circle("10,0").warnings.empty());
  EXPECT_FALSE(read_body("GOTO/.01,0,0\nCIRCLE/0,0,0,0,0,1,.01\nGOTO/0.0086603,.005,0\n")
                   .warned_of("apart"));
}

TEST(Circle, SensesThatGoAgainstTheMotionBeforeThemAreFlagged) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    text += "GOTO/-5,10,0\nGOTO/0,10,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,0\n";
  }
  EXPECT_TRUE(read_body(text).warned_of("--arc-sense"));
  ClReaderOptions options;
  options.arc_sense = ArcSense::kLeft;
  const auto turned = read_text(std::string(kHead) + text + "FINI\n", options);
  EXPECT_TRUE(turned.warnings.empty());
  EXPECT_NEAR(turned.motion().at(2).sweep_rad, kPi / 2, 1e-15);
}

}  // namespace
}  // namespace meridian::cl
