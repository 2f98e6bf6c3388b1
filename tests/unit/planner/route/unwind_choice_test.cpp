// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/unwind_choice.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "meridian/units.hpp"

namespace meridian::test::unwind_choice {
namespace {

/// Travel of three turns and a bit either way; every turn that is tried, best first.
std::vector<int> tried(double at_deg, double beyond_deg, double low_deg = -1100,
                       double high_deg = 1100) {
  JointLimits limits;
  limits.travel_min = units::rad_from_deg(low_deg);
  limits.travel_max = units::rad_from_deg(high_deg);
  UnwindChoice choice(limits, units::rad_from_deg(at_deg), units::rad_from_deg(beyond_deg));
  std::vector<int> out;
  for (int turns = choice.next(); turns != 0; turns = choice.next()) out.push_back(turns);
  EXPECT_EQ(choice.next(), 0);
  return out;
}

TEST(UnwindChoice, TakesTheMostRoomThatLeavesHalfATurnBehind) {
  EXPECT_EQ(tried(1000, 1101), (std::vector{-5, -4, -3, -2, -1}));
  EXPECT_EQ(tried(-1000, -1101), (std::vector{5, 4, 3, 2, 1}));
}

TEST(UnwindChoice, TakesTheWindingWithLessThanHalfATurnBehindItLast) {
  // From 900 down there are 2000: five turns leave 200, from 800 they leave 100.
  EXPECT_EQ(tried(900, 1101), (std::vector{-5, -4, -3, -2, -1}));
  EXPECT_EQ(tried(800, 1101), (std::vector{-4, -3, -2, -1, -5}));
}

TEST(UnwindChoice, HasNoneWhereATurnDoesNotFit) {
  EXPECT_TRUE(tried(150, 201, -200, 200).empty());
  EXPECT_EQ(tried(165, 201, -200, 200), std::vector{-1});
  EXPECT_EQ(tried(160, 201, -200, 200), std::vector{-1}) << "to the end of travel";
}

}  // namespace
}  // namespace meridian::test::unwind_choice
