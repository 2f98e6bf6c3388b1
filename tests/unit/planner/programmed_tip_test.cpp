// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/programmed_tip.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "service/core/planner/singular/pole/programmed_axis.hpp"

namespace meridian {
namespace {

constexpr double kRounding_mm = 1e-12;

TEST(ProgrammedTip, LiesStraightBetweenTheEndsOfBlocks) {
  ProgrammedTip tip(true);
  tip.begin({0, 0, 0});
  tip.add(10, {10, 0, 0});
  tip.add(20, {10, 10, 0});
  EXPECT_NEAR(tip.distance_to(5, {5, 0, 0}), 0, kRounding_mm);
  EXPECT_NEAR(tip.distance_to(5, {5, 0, 0.25}), 0.25, kRounding_mm);
  EXPECT_NEAR(tip.distance_to(15, {10, 5, 0}), 0, kRounding_mm);
}

TEST(ProgrammedTip, IsKnownAsFarBackAsTheProgrammedAxis) {
  EXPECT_EQ(ProgrammedTip::kCapacity, ProgrammedAxis::kCapacity);
}

TEST(ProgrammedTip, IsUnknownOutsideOfTheBlocksAndWhereItIsForgotten) {
  ProgrammedTip tip(true);
  tip.begin({0, 0, 0});
  EXPECT_TRUE(std::isinf(tip.distance_to(0, {0, 0, 0})));
  for (int n = 1; n <= ProgrammedTip::kCapacity + 10; ++n) tip.add(n, {1.0 * n, 0, 0});
  EXPECT_TRUE(std::isinf(tip.distance_to(5, {5, 0, 0})));
  EXPECT_NEAR(tip.distance_to(100, {100, 0, 0}), 0, kRounding_mm);
  EXPECT_TRUE(std::isinf(tip.distance_to(ProgrammedTip::kCapacity + 11, {0, 0, 0})));
}

}  // namespace
}  // namespace meridian
