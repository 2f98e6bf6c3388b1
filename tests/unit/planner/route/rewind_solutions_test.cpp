// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/rewind_solutions.hpp"

#include <gtest/gtest.h>

#include "meridian/units.hpp"

namespace meridian::test::rewind_solutions {
namespace {

RewindSolution with_turns(int turns, double time_s, int carries, double room) {
  RewindSolution one;
  one.target.turns = turns;
  one.time_s = time_s;
  one.carries = carries;
  one.room = room;
  return one;
}

TEST(RewindSolutions, PutsFirstWhatCarriesFarthestThenTheMostRoomThenTheLeastTime) {
  RewindSolutions found;
  found.add(with_turns(1, 3, 5, 0));
  found.add(with_turns(2, 9, 7, 0));
  found.add(with_turns(3, 2, 7, 0));
  found.add(with_turns(4, 8, 7, 1));
  found.sort();
  int order = 0;
  for (const RewindSolution& one : found.all()) order = 10 * order + one.target.turns;
  EXPECT_EQ(order, 4321);
}

TEST(RewindSolutions, CountsTheRoomAheadWhereHalfATurnIsLeftBehind) {
  JointLimits limits;
  limits.travel_min = units::rad_from_deg(-720);
  limits.travel_max = units::rad_from_deg(720);
  EXPECT_NEAR(room_of(limits, units::rad_from_deg(-360), true), units::rad_from_deg(1080), 1e-12);
  EXPECT_NEAR(room_of(limits, units::rad_from_deg(-360), false), units::rad_from_deg(360), 1e-12);
  EXPECT_NEAR(room_of(limits, units::rad_from_deg(-700), true), units::rad_from_deg(-160), 1e-12);
}

}  // namespace
}  // namespace meridian::test::rewind_solutions
