// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/tip_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

/// X 0 to 10, Y -5 to 5, Z 0 to 100.
TipBox drawn_tip_box() { return {true, {0, -5, 0}, {10, 5, 100}}; }

TEST(TipBox, IsWithinItsFacesAndKnowsTheAxisAlongWhichATipIsOutside) {
  const TipBox box = drawn_tip_box();
  EXPECT_EQ(axis_outside(box, {5, 0, 50}), -1);
  EXPECT_EQ(axis_outside(box, {10, -5, 0}), -1) << "its faces";
  EXPECT_EQ(axis_outside(box, {10.001, 0, 50}), 0);
  EXPECT_EQ(axis_outside(box, {5, -5.001, 50}), 1);
  EXPECT_EQ(axis_outside(box, {5, 0, 101}), 2);
  EXPECT_EQ(axis_outside(box, {5, std::numeric_limits<double>::quiet_NaN(), 50}), 1);
  EXPECT_EQ(axis_outside(TipBox{}, {1e9, 0, 0}), -1) << "none is set";
}

TEST(TipBox, LetsATipThatIsOutsideComeInAndStandButNotGoFartherOut) {
  const TipBox box = drawn_tip_box();
  EXPECT_EQ(axis_leaving(box, {12, 0, 50}, {12, 0, 50}, 1e-9), -1);
  EXPECT_EQ(axis_leaving(box, {11, 0, 50}, {12, 0, 50}, 1e-9), -1);
  EXPECT_EQ(axis_leaving(box, {12.001, 0, 50}, {12, 0, 50}, 1e-9), 0);
  EXPECT_EQ(axis_leaving(box, {12, 5.001, 50}, {12, 5, 50}, 1e-9), 1);
}

TEST(TipBox, HasAMinimumBelowAMaximumAlongEachAxis) {
  EXPECT_TRUE(is_tip_box(drawn_tip_box()));
  for (const double end : {10.0, 11.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    TipBox box = drawn_tip_box();
    box.min[0] = end;
    EXPECT_FALSE(is_tip_box(box)) << end;
  }
  TipBox inner = drawn_tip_box();
  EXPECT_TRUE(is_within(inner, drawn_tip_box()));
  EXPECT_TRUE(is_within(inner, TipBox{}));
  inner.max[2] = 100.5;
  EXPECT_FALSE(is_within(inner, drawn_tip_box()));
}

TEST(TipBox, OfALaiMachineIsOverTheBaseWhateverTheTableDoes) {
  const MachineModel model = test::lai_machine();
  const JointVector at_zero{120, 0, -30, 0, 0.4};
  const Array3 tip = tip_over_base(model, 110, at_zero);
  const auto in_machine = pose_in_machine(model, forward(model, 110, at_zero));
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(tip[static_cast<std::size_t>(i)], in_machine.tip[i], 1e-9);
  JointVector turned = at_zero;
  turned[lai::kB2] = 80;
  turned[lai::kTheta1] = 2.1;
  EXPECT_EQ(tip_over_base(model, 110, turned), tip);
  EXPECT_EQ(tip_joints(model), 0b10101U);
}

/// Cubics over one step: where a thousand samples find one outside, beyond_over_step() does too.
TEST(TipBox, MissesNothingThatACurveLeavesBetweenTwoSamples) {
  constexpr unsigned kSeed = 22072;
  std::mt19937_64 engine(kSeed);
  std::uniform_real_distribution<double> at(-1, 11), slope(-12, 12), bend(-6, 6);
  const TipBox box = drawn_tip_box();
  int outside = 0, inside = 0;
  for (int draw = 0; draw < 20000; ++draw) {
    const double c[4] = {at(engine), slope(engine), bend(engine), bend(engine)};
    const auto value = [&c](double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
    bool leaves = false;
    for (int n = 0; n <= 1000 && !leaves; ++n) {
      leaves = beyond_face(box, 0, value(n / 1000.0)) > kTipBoxRounding;
    }
    const double max = std::max(std::abs(2 * c[2]), std::abs(2 * c[2] + 6 * c[3]));
    const TipStep step{value(0), value(1), c[1], c[1] + 2 * c[2] + 3 * c[3], max};
    const bool is_found = beyond_over_step(box, 0, step, 1) > kTipBoxRounding;
    ASSERT_TRUE(is_found || !leaves) << "seed " << kSeed << ", draw " << draw;
    outside += leaves ? 1 : 0;
    inside += is_found ? 0 : 1;
  }
  EXPECT_GT(outside, 2000);
  EXPECT_GT(inside, 2000);
}

TEST(TipBox, CountsAsLeftWhereNoDerivativeBoundsTheTip) {
  const TipStep step{5, 5, 0, 0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_FALSE(beyond_over_step(drawn_tip_box(), 0, step, 1) <= kTipBoxRounding);
}

TEST(TipBox, LeavesALinearJointTheWayToItsFace) {
  const TipBox box = drawn_tip_box();
  using Ends = std::pair<double, double>;
  const auto room = [&box](double at, double slope) {
    Ends ends(-100, 100);
    narrow_inside(box, 0, {at, slope, 0, false}, 20, ends.first, ends.second);
    return ends;
  };
  EXPECT_EQ(room(4, 1), Ends(16, 26));
  EXPECT_EQ(room(4, -1), Ends(14, 24));
  EXPECT_EQ(room(4, 0), Ends(-100, 100)) << "it does not move the tip along X";
  EXPECT_EQ(room(10, 1), Ends(10, 20)) << "from on the face";
  EXPECT_EQ(room(12, 1), Ends(8, 20)) << "from outside the way in alone, and to the other face";
  EXPECT_EQ(room(-1, 1), Ends(20, 31));
}

/// A tip on a circle: its room ends where small steps first leave the box, and never beyond.
TEST(TipBox, LeavesARotaryJointTheWayOnWhichTheTipStaysInside) {
  constexpr unsigned kSeed = 22073;
  constexpr double kStep = 1e-3, kWhole = 6;
  std::mt19937_64 engine(kSeed);
  std::uniform_real_distribution<double> at(-2, 12), amount(-12, 12);
  const TipBox box = drawn_tip_box();
  int bounded = 0;
  for (int draw = 0; draw < 2000; ++draw) {
    const TipCircle t{at(engine), amount(engine), amount(engine), true};
    const auto out = [&](double by) {
      return beyond_face(box, 0, t.at + t.slope * std::sin(by) + t.bend * (1 - std::cos(by)));
    };
    double low = -kWhole, high = kWhole;
    narrow_inside(box, 0, t, 0, low, high);
    ASSERT_LE(low, 0) << draw;
    ASSERT_GE(high, 0) << draw;
    for (const double side : {-1.0, 1.0}) {
      const double end = side > 0 ? high : -low;
      double before = out(0);
      bool leaves = false;
      for (double by = kStep; by < kWhole && !leaves; by += kStep) {
        const double now = out(side * by);
        leaves = now > std::max(1e-7, before + 1e-9);
        ASSERT_FALSE(leaves && by < end - 1e-6) << "seed " << kSeed << ", draw " << draw;
        if (leaves) {
          ASSERT_LE(by - kStep, end + kStep) << "draw " << draw << ": it ends too early";
        }
        before = std::min(before, now);
      }
      bounded += leaves ? 1 : 0;
    }
  }
  EXPECT_GT(bounded, 1000);
}

TEST(TipBox, LeavesNoRoomWhereTheTipTurnsRoundOnItsFaceButForRounding) {
  TipBox box;
  box.is_set = true;
  box.min = {-100, -100, -100};
  box.max = {50, 100, 100};
  for (const double slope : {0.0, 1e-15, -1e-15, 1e-9, -1e-9, 1e-7, -1e-7}) {
    double low = -1, high = 1;
    narrow_inside(box, 0, {50, slope, 100, true}, 0, low, high);
    EXPECT_NEAR(low, 0, 1e-6) << slope;
    EXPECT_NEAR(high, 0, 1e-6) << slope;
  }
}

TEST(TipBox, ARoomOfEachJointEndsWithTheTipOnAFace) {
  MachineModel model = test::lai_machine();
  const JointVector q{20, 5, -30, 1, 0.2};
  const Array3 tip = tip_over_base(model, 110, q);
  model.tip_box = {
      true, {tip[0] - 7, tip[1] - 7, tip[2] - 7}, {tip[0] + 7, tip[1] + 7, tip[2] + 7}};
  for (const int joint : {0, 2, 4}) {
    const auto n = static_cast<std::size_t>(joint);
    double low = -1e3, high = 1e3;
    const auto circles = tip_circles(model, 110, q, joint);
    for (std::size_t i = 0; i < 3; ++i) {
      narrow_inside(model.tip_box, i, circles[i], q[n], low, high);
    }
    for (const double end : {low, high}) {
      JointVector there = q;
      there[n] = end;
      const Array3 at = tip_over_base(model, 110, there);
      double nearest = 1e3;
      for (std::size_t i = 0; i < 3; ++i) {
        const double out = beyond_face(model.tip_box, i, at[i]);
        EXPECT_LE(out, 1e-9) << joint;
        nearest = std::min(nearest, std::abs(out));
      }
      EXPECT_LE(nearest, 1e-9) << joint;
    }
  }
}

}  // namespace
}  // namespace meridian
