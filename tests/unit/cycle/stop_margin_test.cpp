// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/stop_margin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

/// Which of a plan's stop margins a state gets. tests/property/cycle/stop_margin_test.cpp proves
/// that what lies between two of them keeps the joints.
namespace meridian::test::stop_margin_of {
namespace {

/// A piece of a smooth plan: a stop from 50 mm/s or less, or one of two that are harder from 10.
TimePiece smooth_piece() {
  TimePiece piece;
  piece.stop_accel = 100;
  piece.stop_jerk = 1000;
  piece.fault_accel = 200;
  piece.fault_jerk = 4000;
  piece.stop_velocity = 50;
  piece.fault_velocity = 80;
  piece.slow_velocity = 10;
  piece.slow_stop_accel = 300;
  piece.slow_stop_jerk = 3000;
  piece.slow_fault_accel = 500;
  piece.slow_fault_jerk = 9000;
  return piece;
}

void expect_margin(const StopMargin& margin, double accel, double jerk) {
  EXPECT_DOUBLE_EQ(margin.accel, accel);
  EXPECT_DOUBLE_EQ(margin.jerk, jerk);
}

TEST(StopMarginOfAState, IsTheSlowOneUpToItsSpeed) {
  const TimePiece piece = smooth_piece();
  expect_margin(authority_of(piece, StopKind::kHold, {0, 10, 0, 0}), 300, 3000);
  expect_margin(authority_of(piece, StopKind::kFault, {0, 10, 0, 0}), 500, 9000);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 10.001, 0, 0}), 100, 1000);
  expect_margin(authority_of(piece, StopKind::kFault, {0, 10.001, 0, 0}), 200, 4000);
}

TEST(StopMarginOfAState, CountsTheSpeedThatAnAccelerationStillGains) {
  const TimePiece piece = smooth_piece();
  // 120² / (2 · 3000) = 2.4
  expect_margin(authority_of(piece, StopKind::kHold, {0, 7.59, 120, 0}), 300, 3000);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 7.61, 120, 0}), 100, 1000);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 9.9, -120, 0}), 300, 3000);
}

TEST(StopMarginOfAState, IsNoneAboveTheSpeedThatWasLookedAt) {
  const TimePiece piece = smooth_piece();
  expect_margin(authority_of(piece, StopKind::kHold, {0, 50, 0, 0}), 100, 1000);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 50.001, 0, 0}), 0, 0);
  expect_margin(authority_of(piece, StopKind::kFault, {0, 80, 0, 0}), 200, 4000);
  expect_margin(authority_of(piece, StopKind::kFault, {0, 80.001, 0, 0}), 0, 0);
}

TEST(StopMarginOfAState, IsNoneForADecelerationThatComesFromAnotherStop) {
  TimePiece piece = smooth_piece();
  expect_margin(authority_of(piece, StopKind::kHold, {0, 40, -119, 0}), 100, 1000);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 40, -121, 0}), 0, 0);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 5, -299, 0}), 300, 3000);
  expect_margin(authority_of(piece, StopKind::kHold, {0, 5, -301, 0}), 0, 0);
  piece.slow_velocity = 0;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 40, -121, 0}), 100, 1000);
}

TEST(StopMarginOfAState, HasNoSlowOneWithoutJerkOrSpeed) {
  TimePiece piece = smooth_piece();
  piece.slow_velocity = 0;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 0, 0, 0}), 100, 1000);
  piece = smooth_piece();
  piece.slow_stop_jerk = 0;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 5, 0, 0}), 100, 1000);
  piece.slow_velocity = 0.5;
  piece.slow_stop_jerk = 3000;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 0.4, 0, 0}), 300, 3000);
}

TEST(StopMarginOfAState, LiesBetweenThoseAtRestAndTheSlowOneOfASmoothPlan) {
  TimePiece piece = smooth_piece();
  piece.rest_stop_accel = 900;
  piece.rest_stop_jerk = 27000;
  const auto at = [&](double v) { return authority_of(piece, StopKind::kHold, {0, v, 0, 0}); };
  EXPECT_NEAR(at(1e-6).jerk, 27000, 1) << "next to rest";
  double last = 27000;
  for (const double v : {0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 4.0, 9.0}) {
    EXPECT_LE(at(v).jerk, last) << v;
    EXPECT_GE(at(v).jerk, 3000) << v;
    EXPECT_LE(at(v).accel, 900) << v;
    last = at(v).jerk;
  }
  EXPECT_GT(at(0.1).jerk, 20000);
  EXPECT_LT(at(4.0).jerk, 20000);
  EXPECT_GT(at(4.0).jerk, 3300);
  expect_margin(at(10), 300, 3000);
  piece.rest_stop_jerk = 2999;
  expect_margin(at(0.3), 300, 3000);
}

TEST(StopMarginOnALaw, IsThatOfThePieceWhereTheStopLiesAheadOfAllThatHaveIt) {
  const TimePiece piece = smooth_piece();
  const auto on_law = [&](double v, double a, double plan_v = 60, double plan_a = 0) {
    return authority_on_law(piece, StopKind::kHold, {0, v, a, 0}, {0, plan_v, plan_a, 0});
  };
  expect_margin(on_law(40, -90), 100, 1000);
  expect_margin(on_law(5, -90), 300, 3000);
  expect_margin(on_law(47, -90), 0, 0);            // its law comes down from 51.05
  expect_margin(on_law(40, -90, 43), 0, 0);        // and from more than the plan has here
  expect_margin(on_law(40, -101), 0, 0);           // harder than the margin lets it be
  expect_margin(on_law(40, 1), 0, 0);              // it does not brake yet
  expect_margin(on_law(60, -1), 0, 0);             // no slower than the plan
  expect_margin(on_law(40, -90, 80, -361), 0, 0);  // the plan brakes harder at that speed
  expect_margin(on_law(40, -90, 80, -359), 100, 1000);
  TimePiece leg = piece;
  leg.slow_velocity = 0;
  expect_margin(authority_on_law(leg, StopKind::kHold, {0, 5, -9, 0}, {0, 60, 0, 0}), 0, 0);
  expect_margin(authority_on_law(piece, StopKind::kFault, {0, 40, -150, 0}, {0, 60, 0, 0}), 200,
                4000);
}

/// A piece of a plan from rest to rest: 100 and 1000 at 50 mm/s, 300 and 3000 next to rest.
TimePiece plan_from_rest() {
  TimePiece piece = smooth_piece();
  piece.stop_velocity = piece.fault_velocity = 1e9;
  piece.slow_velocity = 0;
  piece.authority_velocity = 50;
  piece.rest_stop_accel = 300;
  piece.rest_stop_jerk = 3000;
  return piece;
}

TEST(StopMarginOfAState, LiesBetweenThoseAtRestAndAtThePlannedSpeed) {
  const TimePiece piece = plan_from_rest();
  const StopMargin got = authority_of(piece, StopKind::kHold, {0, 20, 0, 0});
  // x = 0.4: (1 - x²) 300 + x² 100 = 268, at most 100/x = 250; used sqrt(3000 · 20) = 245.
  EXPECT_NEAR(got.accel, std::sqrt(60000.0), 1e-9);
  const double y = std::max(
      largest_stop_product(20, got.accel, 3000) / largest_stop_product(50, 100, 1000), 0.064);
  EXPECT_NEAR(got.jerk, y <= 1 ? (1 - y) * 3000 + y * 1000 : 1000, 1e-9);
  const StopMargin slower = authority_of(piece, StopKind::kHold, {0, 1, 0, 0});
  EXPECT_NEAR(slower.accel, std::sqrt(3000.0), 1e-9);
  const double y1 =
      largest_stop_product(1, slower.accel, 3000) / largest_stop_product(50, 100, 1000);
  EXPECT_NEAR(slower.jerk, (1 - y1) * 3000 + y1 * 1000, 1e-9);
}

TEST(StopMarginOfAState, IsThatOfThePlannedSpeedWhereTheOtherIsNoHarder) {
  TimePiece piece = plan_from_rest();
  piece.rest_stop_accel = 99;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 1, 0, 0}), 100, 1000);
  piece = plan_from_rest();
  piece.rest_stop_jerk = 999;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 1, 0, 0}), 100, 1000);
  piece = plan_from_rest();
  expect_margin(authority_of(piece, StopKind::kHold, {0, 50, 0, 0}), 100, 1000);
  piece.authority_velocity = 0;
  expect_margin(authority_of(piece, StopKind::kHold, {0, 1, 0, 0}), 100, 1000);
}

}  // namespace
}  // namespace meridian::test::stop_margin_of
