// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/winding.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace meridian {
namespace {

TEST(Winding, TakesTheShortWayAcrossPi) {
  EXPECT_NEAR(nearest_winding(-3.1, 3.1), -3.1 + kTurn_rad, 1e-15);
  EXPECT_NEAR(nearest_winding(3.1, -3.1), 3.1 - kTurn_rad, 1e-15);
}

TEST(Winding, LeavesAnAngleNearItsReferenceAlone) {
  EXPECT_EQ(nearest_winding(0.3, 0.4), 0.3);
  EXPECT_EQ(nearest_winding(0.0, 3.1), 0.0);
}

TEST(Winding, FollowsManyTurns) {
  EXPECT_NEAR(nearest_winding(0.5, 1000 * kTurn_rad), 0.5 + 1000 * kTurn_rad, 1e-12);
  EXPECT_NEAR(nearest_winding(0.5, -1000 * kTurn_rad), 0.5 - 1000 * kTurn_rad, 1e-12);
}

TEST(Winding, IsNeverFartherThanHalfATurn) {
  for (int i = -1000; i <= 1000; ++i) {
    const double reference = 0.0173 * i * 7;
    EXPECT_LE(std::abs(nearest_winding(2.9, reference) - reference), std::numbers::pi + 1e-13);
  }
}

TEST(Winding, PassesOnWhatIsNotANumber) {
  EXPECT_TRUE(std::isnan(nearest_winding(std::numeric_limits<double>::quiet_NaN(), 0)));
}

TEST(Winding, MovesIntoTravelWhereItCan) {
  struct Case {
    double angle, reference, minimum, maximum, expected;
  };
  const Case cases[] = {
      {-0.5, 0.2, 0, 6, -0.5 + kTurn_rad},     // below: up by a turn
      {0.5, 6.5, -6, 0, 0.5 - kTurn_rad},      // above: down, not up
      {0.5, 40, -10, 10, 0.5 + kTurn_rad},     // far above: the highest inside
      {0.5, -40, -10, 10, 0.5 - kTurn_rad},    // far below: the lowest inside
      {2.0, 0.1, -1, 1, 2.0},                  // nowhere inside: nearest to the reference
      {1.0 + 1e-12, 0.9, -1, 1, 1.0 + 1e-12},  // on the edge but for rounding: stays
      {3.0, -3.1, -4, 4, 3.0 - kTurn_rad},     // inside already: the short way
      {3.0, -3.1, -3.2, 3.2, 3.0},             // the short way ends outside: the long way
  };
  for (const Case& c : cases) {
    EXPECT_NEAR(nearest_winding_inside(c.angle, c.reference, c.minimum, c.maximum, 1e-9),
                c.expected, 1e-12)
        << c.angle << " near " << c.reference << " in [" << c.minimum << ", " << c.maximum << "]";
  }
}

}  // namespace
}  // namespace meridian
