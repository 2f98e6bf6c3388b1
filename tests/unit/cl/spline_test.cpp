// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

/// Without inner knots a clamped cubic is the Bezier curve of its four points.
Vector3 bezier(const std::array<Vector3, 4>& p, double u) {
  const double v = 1 - u;
  return v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3];
}

double distance_to_chords(const Vector3& p, Vector3 from, const std::vector<ToolPose>& chords) {
  double nearest = 1e9;
  for (const ToolPose& to : chords) {
    const Vector3 d = to.tip - from;
    const double along = std::clamp(d.dot(p - from) / d.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - from - along * d).norm());
    from = to.tip;
  }
  return nearest;
}

ClampedCubic two_spans() {
  ClampedCubic spline;
  spline.inner_knots = {.5};
  for (const Vector3& p :
       {Vector3(0, 0, 0), Vector3(1, 0, 1), Vector3(3, 0, 2), Vector3(5, 0, 1), Vector3(6, 0, 0)}) {
    spline.points.push_back({p, Vector3::UnitZ()});
  }
  return spline;
}

TEST(Spline, WithoutInnerKnotsIsTheBezierCurveOfItsPoints) {
  const std::array<Vector3, 4> p{Vector3(0, 0, 0), Vector3(10, 0, 5), Vector3(20, 30, 5),
                                 Vector3(40, 0, 0)};
  ClampedCubic spline;
  for (const Vector3& point : p) spline.points.push_back({point, Vector3::UnitZ()});
  for (double u = 0; u <= 1; u += .125) {
    EXPECT_LE((spline.at(u).tip - bezier(p, u)).norm(), 1e-12) << u;
  }
}

/// By hand: at the knot 1/2 the middle control point weighs 1/2, its neighbours 1/4 each.
TEST(Spline, WithOneInnerKnotGoesThroughTheMeanAtIt) {
  const Vector3 at = two_spans().at(.5).tip;
  EXPECT_NEAR(at[0], (1 + 2 * 3 + 5) / 4.0, 1e-12);
  EXPECT_NEAR(at[2], (1 + 2 * 2 + 1) / 4.0, 1e-12);
}

TEST(Spline, LiesWithinTheToleranceOfItsChords) {
  const ClampedCubic spline = two_spans();
  const auto chords = chords_of(spline, {1e-3, 1e-5});
  ASSERT_GT(chords.size(), 10U);
  EXPECT_LT(chords.size(), 100U);
  EXPECT_EQ(chords.back().tip, Vector3(6, 0, 0));
  double farthest = 0;
  for (double u = 0; u <= 1; u += 1e-3) {
    farthest =
        std::max(farthest, distance_to_chords(spline.at(u).tip, spline.points[0].tip, chords));
  }
  EXPECT_LE(farthest, 1e-3);
  EXPECT_GT(farthest, 1e-5);  // the tolerance is used
}

TEST(Spline, TurnsItsAxisWithinTheToleranceAsUnitVectors) {
  ClampedCubic spline = two_spans();
  spline.points[3].axis = spline.points[4].axis = Vector3(.6, 0, .8);
  const auto chords = chords_of(spline, {1, 1e-4});
  EXPECT_GT(chords.size(), 20U);
  for (const ToolPose& pose : chords) EXPECT_NEAR(pose.axis.norm(), 1, 1e-12);
  EXPECT_LE((chords.back().axis - Vector3(.6, 0, .8)).norm(), 1e-12);
}

TEST(Spline, OfTooManyChordsIsNone) { EXPECT_TRUE(chords_of(two_spans(), {1e-12, 1}).empty()); }

constexpr const char* kSplineOfNx =
    "GOTO/0,0,0\nNURBS/\nKNOT/0.5000000,1.0000000\nPAINT/COLOR,31\nCNTRL/1,0,1\nCNTRL/3,0,2\n"
    "CNTRL/5,0,1\nCNTRL/6,0,0\nGOTO/7,0,0\n";

TEST(Spline, OfNxBeginsWhereTheToolIsAndIsCutIntoBlocks) {
  const auto read = read_body(kSplineOfNx);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.splines, 1U);
  EXPECT_EQ(read.summary.dialect, "NX CLSF");
  const auto m = read.motion();
  const auto chords = chords_of(two_spans(), {});
  ASSERT_EQ(m.size(), chords.size() + 2);
  for (std::size_t i = 0; i < chords.size(); ++i) {
    EXPECT_LE((to_vector(m[i + 1].tip_mm) - chords[i].tip).norm(), 1e-9);
  }
  EXPECT_EQ(m.back().tip_mm, (Array3{7, 0, 0}));
}

TEST(Spline, OfNxFollowsAnotherDirectly) {
  const auto read = read_body(
      "GOTO/0,0,0\nNURBS/\nKNOT/1\nCNTRL/1,0,0\nCNTRL/2,0,0\nCNTRL/3,0,0\nNURBS/\nKNOT/1\n"
      "CNTRL/4,0,0\nCNTRL/5,0,0\nCNTRL/6,0,0\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.splines, 2U);
  EXPECT_EQ(read.motion().back().tip_mm, (Array3{6, 0, 0}));
  EXPECT_NEAR(read.summary.cut_length_mm, 6, 1e-9);
}

struct Wrong {
  const char* body;
  const char* reason;
};

class SplineRefused : public testing::TestWithParam<Wrong> {};

TEST_P(SplineRefused, WithTheReason) {
  const auto read = read_body(std::string("GOTO/0,0,0\n") + GetParam().body);
  EXPECT_NE(read.error.find(GetParam().reason), std::string::npos) << read.error;
}

INSTANTIATE_TEST_SUITE_P(
    Nx, SplineRefused,
    testing::Values(Wrong{"NURBS/3,1\nGOTO/1,0,0\n", "a form that is not understood"},
                    Wrong{"KNOT/1\nGOTO/1,0,0\n", "without the NURBS"},
                    Wrong{"CNTRL/1,0,0\nGOTO/1,0,0\n", "without the NURBS"},
                    Wrong{"NURBS/\nKNOT/.5,.4\nGOTO/1,0,0\n", "do not rise"},
                    Wrong{"NURBS/\nKNOT/.5,2\nGOTO/1,0,0\n", "do not rise"},
                    Wrong{"NURBS/\nKNOT/.5\nCNTRL/1,0,0\n", "before the knots have come to 1"},
                    Wrong{"NURBS/\nKNOT/1\nCNTRL/1,0\n", "3 or 6 numbers"},
                    Wrong{"NURBS/\nKNOT/1\nCNTRL/1,0,0\nCNTRL/2,0,0,0,0,1\n",
                          "beside CNTRL without"},
                    Wrong{"NURBS/\nKNOT/1\nCNTRL/1,0,0\nGOTO/1,0,0\n", "fewer control points"},
                    Wrong{"NURBS/\nKNOT/1\nCNTRL/1,0,0\n", "without all of its control points"},
                    Wrong{"NURBS/\nKNOT/1\nLOADTL/2\n", "between NURBS"}));

TEST(Spline, BeforeAnyPositionIsRefused) {
  const auto read = read_body("NURBS/\nKNOT/1\nCNTRL/1,0,0\nCNTRL/2,0,0\nCNTRL/3,0,0\n");
  EXPECT_NE(read.error.find("before any position"), std::string::npos) << read.error;
}

}  // namespace
}  // namespace meridian::cl
