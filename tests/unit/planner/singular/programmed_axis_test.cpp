// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/programmed_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace meridian::test::programmed_axis {
namespace {

/// The axis leaning by `angle` towards x.
Vector3 leaning(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }

TEST(ProgrammedAxis, LiesOnAGreatCircleBetweenTheEndsOfBlocks) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  axis.add(10, leaning(0.2));
  axis.add(20, leaning(-0.2));
  axis.add(21, leaning(0.3));
  for (const auto& [u, angle] : {std::pair{0.0, 0.0},
                                 {2.5, 0.05},
                                 {10.0, 0.2},
                                 {15.0, 0.0},
                                 {20.0, -0.2},
                                 {20.5, 0.05},
                                 {21.0, 0.3}}) {
    const auto there = axis.at(u);
    ASSERT_TRUE(there) << u;
    EXPECT_NEAR((there->axis - leaning(angle)).norm(), 0, 1e-12) << u;
    EXPECT_EQ(there->hidden_rad, 0);
    EXPECT_NEAR(axis.angle_to(u, leaning(angle + 0.01)), 0.01, 1e-9) << u;
  }
}

TEST(ProgrammedAxis, IsUnknownOutsideOfTheBlocks) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  EXPECT_FALSE(axis.at(0)) << "one end alone is no block";
  EXPECT_TRUE(std::isinf(axis.angle_to(0, leaning(0))));
  axis.add(10, leaning(0.2));
  EXPECT_FALSE(axis.at(-0.001));
  EXPECT_FALSE(axis.at(10.001));
  EXPECT_TRUE(axis.at(10));
  axis.begin(leaning(0.5));
  EXPECT_FALSE(axis.at(5)) << "it begins again";
}

TEST(ProgrammedAxis, MergesEndsThatLieCloseAndReportsWhatThatHides) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  axis.add(10, leaning(0.1));
  axis.add(10.004, leaning(0.103));
  axis.add(10.008, leaning(0.101));
  axis.add(20, leaning(0.2));
  const auto there = axis.at(10.004);
  ASSERT_TRUE(there);
  EXPECT_NEAR(there->hidden_rad, 2 * 0.003, 1e-12) << "twice the farthest from the end before";
  EXPECT_NEAR(axis.angle_to(10.004, leaning(0.1005)), 0.006, 1e-9);
  EXPECT_EQ(axis.at(15)->hidden_rad, 0);
  EXPECT_NEAR((axis.at(10.008)->axis - leaning(0.101)).norm(), 0, 1e-12);
}

TEST(ProgrammedAxis, KeepsEndsThatLieNoCloserThanTheGap) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  axis.add(10, leaning(0.1));
  axis.add(10.0101, leaning(0.103));
  EXPECT_EQ(axis.at(10.005)->hidden_rad, 0);
  EXPECT_NEAR(axis.next_end(9), 10, 0);
}

TEST(ProgrammedAxis, KnowsWhereTheNextBlockEnds) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  axis.add(10, leaning(0.1));
  axis.add(20, leaning(0.2));
  EXPECT_EQ(axis.next_end(-1), 0);
  EXPECT_EQ(axis.next_end(0), 10);
  EXPECT_EQ(axis.next_end(9.9), 10);
  EXPECT_EQ(axis.next_end(10), 20);
  EXPECT_TRUE(std::isinf(axis.next_end(20)));
}

TEST(ProgrammedAxis, ForgetsWhatIsTooLongAgo) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  for (int n = 1; n <= ProgrammedAxis::kCapacity + 10; ++n) axis.add(n, leaning(0.001 * (n % 7)));
  EXPECT_FALSE(axis.at(5));
  EXPECT_TRUE(axis.at(11));
  EXPECT_NEAR((axis.at(100)->axis - leaning(0.001 * (100 % 7))).norm(), 0, 1e-12);
}

TEST(ProgrammedAxis, FindsTheSharpestChangeOfDirectionOfEveryPart) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  // Rates 0, 0.01, 0.04, 0.03, 0.03, then -0.02 and straight on.
  constexpr std::array kRates{0.0, 0.01, 0.04, 0.03, 0.03, -0.02, -0.02};
  double angle = 0;
  for (std::size_t n = 0; n < kRates.size(); ++n) {
    angle += 10 * kRates[n];
    axis.add(10.0 * static_cast<double>(n + 1), leaning(angle));
  }
  std::array<double, 2> two{};
  ASSERT_EQ(axis.find_kinks(0, 70, two), 2U);
  EXPECT_EQ(two[0], 20) << "from 0.01 to 0.04 per mm";
  EXPECT_EQ(two[1], 50) << "from 0.03 to -0.02";
  std::array<double, 7> all{};
  ASSERT_GE(axis.find_kinks(0, 70, all), 4U);
  EXPECT_EQ(all[0], 10);
  EXPECT_EQ(all[1], 20);
  EXPECT_EQ(all[2], 30);
  std::array<double, 1> one{};
  ASSERT_EQ(axis.find_kinks(25, 45, one), 1U) << "inside of the range alone";
  EXPECT_EQ(one[0], 30);
  ASSERT_EQ(axis.find_kinks(20, 45, one), 1U) << "nor at its begin";
  EXPECT_EQ(one[0], 30);
  const std::size_t count = axis.find_kinks(0, 200, all);
  EXPECT_LT(*std::max_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)), 70)
      << "the last end is no kink: nothing is known behind it";
}

TEST(ProgrammedAxis, FindsEveryChangeOfDirectionWhereThereIsRoomHoweverCloseTheyLie) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  axis.add(10, leaning(0.1));
  axis.add(10.08, leaning(0.1));
  axis.add(10.16, leaning(0.101));
  axis.add(90, leaning(0));
  axis.add(100, leaning(0));
  std::array<double, 4> kinks{};
  ASSERT_EQ(axis.find_kinks(0, 95, kinks), 4U);
  EXPECT_EQ(kinks, (std::array{10.0, 10.08, 10.16, 90.0}));
  std::array<double, 3> few{};
  ASSERT_EQ(axis.find_kinks(0, 95, few), 2U) << "the sharpest of every third of the range";
  EXPECT_EQ(few[1], 90);
}

TEST(ProgrammedAxis, CountsPartsFromTheBeginOfTheRangeToItsEnd) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  // A kink at every end of a block, each sharper than the one before.
  for (int n = 1; n <= 12; ++n) axis.add(10.0 * n, leaning((n % 2 == 0 ? 0.002 : -0.002) * n));
  std::array<double, 2> two{};
  ASSERT_EQ(axis.find_kinks(55, 105, two), 2U);
  EXPECT_EQ(two[0], 70) << "the sharpest from 55 to 80";
  EXPECT_EQ(two[1], 100);
  ASSERT_EQ(axis.find_kinks(55, 100, two), 2U);
  EXPECT_EQ(two[0], 70);
  EXPECT_EQ(two[1], 90) << "what lies at its end is not between";
}

TEST(ProgrammedAxis, HasAKinkWhereTheDirectionChangesByMoreThanRounding) {
  for (const double kink_per_mm : {0.8e-6, 1.5e-6}) {
    ProgrammedAxis axis;
    axis.begin(leaning(0));
    axis.add(10, leaning(0));
    axis.add(20, leaning(10 * kink_per_mm));
    std::array<double, 4> kinks{};
    EXPECT_EQ(axis.find_kinks(0, 20, kinks), kink_per_mm > 1e-6 ? 1U : 0U);
  }
}

TEST(ProgrammedAxis, HasNoKinkWhereItTurnsEvenly) {
  ProgrammedAxis axis;
  axis.begin(leaning(0));
  for (int n = 1; n < 8; ++n) axis.add(0.01 * n + 5 * n, leaning(1e-7 * n));
  std::array<double, 4> kinks{};
  EXPECT_EQ(axis.find_kinks(0, 30, kinks), 0U);
}

}  // namespace
}  // namespace meridian::test::programmed_axis
