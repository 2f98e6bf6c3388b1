// SPDX-License-Identifier: Apache-2.0
#include "meridian/geometry/great_circle.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace meridian {
namespace {

constexpr double kAxisTolerance = 4e-16;  // a few eps of unit vectors

TEST(GreatCircle, BeginsAndEndsOnTheAxesGiven) {
  const Vector3 begin = Vector3(0.3, -0.5, 0.8).normalized();
  const Vector3 end = Vector3(-0.2, 0.9, 0.1).normalized();
  const GreatCircle circle = find_great_circle(begin, end);
  EXPECT_TRUE(circle.is_unique);
  EXPECT_EQ(axis_on_circle(begin, circle.normal, 0.0), begin);
  EXPECT_LT((axis_on_circle(begin, circle.normal, circle.turn) - end).norm(), kAxisTolerance);
}

TEST(GreatCircle, StaysUnitAndInOnePlane) {
  const Vector3 begin = Vector3(0.3, -0.5, 0.8).normalized();
  const Vector3 end = Vector3(-0.2, 0.9, 0.1).normalized();
  const GreatCircle circle = find_great_circle(begin, end);
  const Vector3 pole = begin.cross(end).normalized();
  for (int i = 0; i <= 10; ++i) {
    const Vector3 axis = axis_on_circle(begin, circle.normal, circle.turn * i / 10);
    EXPECT_NEAR(axis.norm(), 1, kAxisTolerance);
    EXPECT_NEAR(axis.dot(pole), 0, kAxisTolerance);
  }
}

TEST(GreatCircle, KeepsTheDirectionOfAVeryShortTurn) {
  const Vector3 begin(0, 0, 1);
  for (const double turn : {1e-3, 1e-7, 1e-12}) {
    const Vector3 end(0.6 * turn, 0.8 * turn, 1);
    const GreatCircle circle = find_great_circle(begin, end);
    EXPECT_NEAR(circle.turn / turn, 1, 1e-6);
    EXPECT_LT((circle.normal - Vector3(0.6, 0.8, 0)).norm(), 1e-15);
  }
}

TEST(GreatCircle, OfEqualAxesDoesNotTurn) {
  const Vector3 axis = Vector3(1, 2, 3).normalized();
  const GreatCircle circle = find_great_circle(axis, axis);
  EXPECT_EQ(circle.turn, 0);
  EXPECT_TRUE(circle.is_unique);
  EXPECT_NEAR(circle.normal.norm(), 1, kAxisTolerance);
  EXPECT_NEAR(circle.normal.dot(axis), 0, kAxisTolerance);
}

TEST(GreatCircle, OfOppositeAxesIsNotUnique) {
  const Vector3 axis = Vector3(1, 2, 3).normalized();
  const GreatCircle circle = find_great_circle(axis, -axis);
  EXPECT_FALSE(circle.is_unique);
  EXPECT_NEAR(circle.turn, std::numbers::pi, 1e-15);
  EXPECT_NEAR(circle.normal.norm(), 1, kAxisTolerance);
  EXPECT_TRUE(find_great_circle({0, 0, 1}, {1e-6, 0, -1}).is_unique);
}

TEST(GreatCircle, AngleIsAccurateNearZeroAndNearPi) {
  for (const double angle : {1e-14, 1e-9, 1e-3, 1.0, 3.0}) {
    EXPECT_NEAR(angle_between({1, 0, 0}, {std::cos(angle), std::sin(angle), 0}) / angle, 1, 1e-15);
  }
  EXPECT_NEAR(angle_between({2, 0, 0}, {-3, 3e-9, 0}), std::numbers::pi - 1e-9, 1e-15);
}

TEST(GreatCircle, GivesTheTurningRateInJets) {
  const Vector3 begin(0, 0, 1);
  const GreatCircle circle = find_great_circle(begin, {1, 0, 0});
  const Vec3<Jet<1>> axis = axis_on_circle(begin, circle.normal, Jet<1>::variable(0.3));
  const Vector3 rate(axis[0].derivative(1), axis[1].derivative(1), axis[2].derivative(1));
  EXPECT_NEAR(rate.norm(), 1, kAxisTolerance);
}

}  // namespace
}  // namespace meridian
