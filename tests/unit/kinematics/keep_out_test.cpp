// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/keep_out.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace meridian {
namespace {

/// X from 10 to 20 while Z is from -5 to 5: joints 0 and 2.
KeepOutBox vice() {
  KeepOutBox box;
  box.name = {"vice"};
  box.joints = 0b101;
  box.min = {10, 0, -5};
  box.max = {20, 0, 5};
  return box;
}

KeepOut only(const KeepOutBox& box) {
  KeepOut out;
  EXPECT_TRUE(out.add(box));
  return out;
}

TEST(KeepOut, HoldsWhatIsInsideWithAllOfItsJoints) {
  const KeepOut keep_out = only(vice());
  EXPECT_EQ(keep_out_at(keep_out, {15, 1000, 0}), 0);
  EXPECT_DOUBLE_EQ(depth_inside(vice(), {12, 0, 4}), 1);
  EXPECT_EQ(keep_out_at(keep_out, {15, 0, 5.001}), -1);
  EXPECT_EQ(keep_out_at(keep_out, {9.999, 0, 0}), -1);
  EXPECT_EQ(keep_out_at(keep_out, {10, 0, 0}), -1) << "the face is allowed";
  EXPECT_EQ(keep_out_at(keep_out, {10 + 1e-10, 0, 0}), -1) << "and its rounding";
  EXPECT_EQ(keep_out_at(KeepOut(), {15, 0, 0}), -1);
}

TEST(KeepOut, HoldsEightBoxesAndFindsTheOneOfAPlace) {
  KeepOut keep_out;
  KeepOutBox box = vice();
  for (int n = 0; n < KeepOut::kMax; ++n) {
    box.min[0] = 100.0 * n;
    box.max[0] = 100.0 * n + 1;
    EXPECT_TRUE(keep_out.add(box));
  }
  EXPECT_FALSE(keep_out.add(box));
  EXPECT_EQ(keep_out_at(keep_out, {700.5, 0, 0}), 7);
  EXPECT_STREQ(keep_out.name_of(7), "vice");
  EXPECT_STREQ(keep_out.name_of(8), "?");
  EXPECT_STREQ(keep_out.name_of(-1), "?");
}

TEST(KeepOut, IsEnteredBetweenTwoPlacesThatAreBothOutside) {
  const KeepOut keep_out = only(vice());
  const auto entry = keep_out_between(keep_out, {0, 0, 0}, {40, 7, 0});
  EXPECT_EQ(entry.box, 0);
  EXPECT_NEAR(entry.share, 0.25, 1e-9);
  EXPECT_EQ(keep_out_between(keep_out, {0, 0, 5}, {40, 0, 5}).box, -1) << "along a face";
  EXPECT_EQ(keep_out_between(keep_out, {0, 0, 0}, {10, 0, 0}).box, -1) << "up to a face";
  EXPECT_EQ(keep_out_between(keep_out, {5, 0, 0}, {15, 0, 10}).box, -1) << "past an edge";
  EXPECT_EQ(keep_out_between(keep_out, {5.1, 0, 0}, {15.1, 0, 10}).box, 0) << "over an edge";
  EXPECT_EQ(keep_out_between(keep_out, {15, 0, 0}, {15, 0, 0}).share, 0) << "standing inside";
}

TEST(KeepOut, IsEnteredWhereNobodyKnowsHowFarAJointIsBesideItsWay) {
  const KeepOut keep_out = only(vice());
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  EXPECT_EQ(keep_out_between(keep_out, {0, 0, 0}, {1, 0, 0}, {kAnywhere}).box, 0);
  EXPECT_EQ(keep_out_between(keep_out, {0, 0, 0}, {0, 0, 0}, {kAnywhere}).box, 0);
  EXPECT_EQ(keep_out_between(keep_out, {0, 0, 9}, {1, 0, 9}, {kAnywhere}).box, -1);
}

TEST(KeepOut, ReportsTheFirstOfSeveralBoxes) {
  KeepOut keep_out = only(vice());
  KeepOutBox nearer = vice();
  nearer.min[0] = 2;
  nearer.max[0] = 3;
  ASSERT_TRUE(keep_out.add(nearer));
  EXPECT_EQ(keep_out_between(keep_out, {0, 0, 0}, {40, 0, 0}).box, 1);
  EXPECT_EQ(keep_out_between(keep_out, {40, 0, 0}, {0, 0, 0}).box, 0);
}

/// Cubics of two joints over one step: where a thousand samples find one inside of the box, the
/// straight way with h²/8 of the largest second derivative beside it finds it too.
TEST(KeepOut, MissesNothingThatACurveEntersBetweenTwoSamples) {
  constexpr unsigned kSeed = 22071;
  std::mt19937_64 engine(kSeed);
  std::uniform_real_distribution<double> at(0, 30), slope(-12, 12), bend(-6, 6);
  const KeepOut keep_out = only(vice());
  int inside = 0, passed = 0;
  for (int draw = 0; draw < 20000; ++draw) {
    const double c[2][4] = {{at(engine), slope(engine), bend(engine), bend(engine)},
                            {at(engine) - 15, slope(engine), bend(engine), bend(engine)}};
    const auto position = [&c](double t) {
      const auto value = [t](const double* k) { return k[0] + t * (k[1] + t * (k[2] + t * k[3])); };
      return JointVector{value(c[0]), 0, value(c[1])};
    };
    bool enters = false;
    for (int n = 0; n <= 1000 && !enters; ++n)
      enters = keep_out_at(keep_out, position(n / 1000.0)) >= 0;
    JointVector off{};
    for (const int i : {0, 1}) {
      const double max = std::max(std::abs(2 * c[i][2]), std::abs(2 * c[i][2] + 6 * c[i][3]));
      off[static_cast<std::size_t>(2 * i)] = max / 8;
    }
    const bool is_found = keep_out_between(keep_out, position(0), position(1), off).box >= 0;
    ASSERT_TRUE(is_found || !enters) << "seed " << kSeed << ", draw " << draw;
    inside += enters ? 1 : 0;
    passed += is_found ? 0 : 1;
  }
  EXPECT_GT(inside, 2000);
  EXPECT_GT(passed, 2000);
}

TEST(KeepOut, LeavesAJointTheWayToItsFace) {
  const KeepOut keep_out = only(vice());
  const auto room = [&keep_out](const JointVector& q, int joint, std::uint32_t known = ~0U) {
    std::pair<double, double> ends(-100, 100);
    narrow_outside(keep_out, q, joint, known, ends.first, ends.second);
    return ends;
  };
  using Ends = std::pair<double, double>;
  EXPECT_EQ(room({0, 0, 0}, 0), Ends(-100, 10));
  EXPECT_EQ(room({30, 0, 0}, 0), Ends(20, 100));
  EXPECT_EQ(room({10, 0, 0}, 0), Ends(-100, 10));
  EXPECT_EQ(room({0, 0, 6}, 0), Ends(-100, 100)) << "over it";
  EXPECT_EQ(room({15, 0, 6}, 2), Ends(5, 100));
  EXPECT_EQ(room({0, 0, 0}, 1), Ends(-100, 100)) << "no joint of the box";
  EXPECT_EQ(room({0, 0, 0}, 0, 0b001), Ends(-100, 100)) << "where Z is, nobody knows";
  EXPECT_EQ(room({12, 0, 0}, 0), Ends(-100, 12)) << "from inside to the nearer face alone";
  EXPECT_EQ(room({19, 0, 0}, 0), Ends(19, 100));
}

TEST(KeepOut, OfOneJointIsAGapInItsTravel) {
  KeepOutBox gap = vice();
  gap.joints = 0b001;
  double low = -100, high = 100;
  narrow_outside(only(gap), {0, 0, 99}, 0, ~0U, low, high);
  EXPECT_EQ(low, -100);
  EXPECT_EQ(high, 10);
}

}  // namespace
}  // namespace meridian
