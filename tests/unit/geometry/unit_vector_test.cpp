// SPDX-License-Identifier: Apache-2.0
#include "meridian/geometry/unit_vector.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace meridian {
namespace {

TEST(UnitVector, NormalisesWhatIsNearlyUnit) {
  const auto axis = UnitVector3::near_unit({0.6, 0, 0.8005});
  ASSERT_TRUE(axis.has_value());
  EXPECT_NEAR(axis->vector().norm(), 1, 3e-16);
}

TEST(UnitVector, RefusesWhatIsNotNearlyUnit) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Vector3& bad : {Vector3(0, 0, 0), Vector3(0, 0, 1.0011), Vector3(0, 0, 0.9989),
                             Vector3(kNan, 0, 1), Vector3(kInfinity, 0, 0)}) {
    EXPECT_FALSE(UnitVector3::near_unit(bad).has_value()) << bad.transpose();
  }
}

TEST(UnitVector, TakesTheDirectionOfAnyLength) {
  const auto axis = UnitVector3::along({3e-200, 0, 4e-200});
  ASSERT_TRUE(axis.has_value());
  EXPECT_NEAR(axis->vector()[0], 0.6, 1e-15);
  EXPECT_FALSE(UnitVector3::along({0, 0, 0}).has_value());
}

}  // namespace
}  // namespace meridian
