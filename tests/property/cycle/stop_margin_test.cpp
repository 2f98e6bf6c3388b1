// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/stop_margin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>

#include "support/draws.hpp"

/// Between rest and the planned speed: whatever the joints' derivatives along the path are, the
/// authority keeps what they may do.
namespace meridian::test::stop_margin {
namespace {

constexpr unsigned kSeed = 20240630;
constexpr int kDraws = test::draws(20000);

struct Row {
  double d1, d2, d3;  // |q'|, |q''|, |q'''|
  double accel, jerk;
};

double accel_at(const std::array<Row, 5>& rows, double v) {
  double max = 1e12;
  for (const Row& r : rows) max = std::min(max, (r.accel - r.d2 * v * v) / r.d1);
  return max;
}
double jerk_at(const std::array<Row, 5>& rows, double v, double product) {
  double max = 1e12;
  for (const Row& r : rows) {
    max = std::min(max, (r.jerk - 3 * r.d2 * product - r.d3 * v * v * v) / r.d1);
  }
  return max;
}

TEST(StopMargin, KeepsEveryJointBetweenRestAndThePlannedSpeed) {
  std::cout << "seed " << kSeed << ", " << kDraws << " draws\n";
  std::mt19937_64 draw(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  int used = 0;
  for (int n = 0; n < kDraws; ++n) {
    std::array<Row, 5> rows;
    for (Row& r : rows) {
      r = {std::pow(10, -3 + 4 * unit(draw)), std::pow(10, -5 + 4 * unit(draw)),
           std::pow(10, -7 + 5 * unit(draw)), 3000 * unit(draw) + 1, 60000 * unit(draw) + 1};
    }
    TimePiece piece;
    const double v1 = piece.authority_velocity = 100 * unit(draw);
    piece.stop_accel = accel_at(rows, v1) * unit(draw);
    if (!(piece.stop_accel > 0)) continue;
    const double product = largest_stop_product(v1, piece.stop_accel, jerk_at(rows, v1, 0));
    piece.stop_jerk = jerk_at(rows, v1, product);
    if (!(piece.stop_jerk > 0)) continue;
    piece.rest_stop_accel = accel_at(rows, 0);
    piece.rest_stop_jerk = jerk_at(rows, 0, 0);
    const PathState state{0, v1 * unit(draw), piece.stop_accel * (2 * unit(draw) - 1), 0};
    const StopMargin got = authority_of(piece, StopKind::kHold, state);
    const double rise = std::max(state.dds, 0.0);
    const double peak = std::min(v1, state.ds + 0.5 * rise * rise / piece.stop_jerk);
    EXPECT_LE(got.accel, accel_at(rows, peak) * (1 + 1e-9));
    // What the stop really does, followed from its begin to its end.
    const StopLaw law(state, got);
    double largest = 0;
    for (int k = 0; k <= 200; ++k) {
      const PathState at = law.at(law.duration() * k / 200);
      largest = std::max(largest, at.ds * std::abs(at.dds));
    }
    const double top = state.ds + 0.5 * state.dds * state.dds / got.jerk;
    EXPECT_LE(largest, largest_stop_product(top, got.accel, got.jerk) * (1 + 1e-9));
    if (top <= v1) {
      EXPECT_LE(got.jerk, jerk_at(rows, peak, largest) * (1 + 1e-9));
    }
    EXPECT_GE(got.jerk, piece.stop_jerk * (1 - 1e-9));
    used += got.jerk > 1.01 * piece.stop_jerk;
  }
  EXPECT_GT(used, test::draws(100));
}

/// Of a smooth plan: a cell ahead has limits that the stop from the slow speed just keeps there, by
/// its own speed in it. Every slower stop keeps them too, however far ahead the cell is.
TEST(StopMargin, OfASmoothPlanKeepsTheLimitsOfEveryCellAheadBetweenRestAndTheSlowSpeed) {
  std::cout << "seed " << kSeed + 1 << ", " << kDraws << " draws\n";
  std::mt19937_64 draw(kSeed + 1);
  std::uniform_real_distribution<double> unit(0, 1);
  int used = 0;
  for (int n = 0; n < kDraws; ++n) {
    TimePiece piece;
    const double v1 = piece.slow_velocity = 100 * unit(draw) + 1;
    piece.slow_stop_jerk = 1e4 * std::pow(30, unit(draw));
    const double deepest = std::sqrt(piece.slow_stop_jerk * v1);
    piece.slow_stop_accel = deepest * (0.3 + unit(draw));
    const StopMargin slow{piece.slow_stop_accel, piece.slow_stop_jerk};
    const double a1 = -0.9 * std::min(slow.accel, deepest) * unit(draw);
    const StopLaw fast({0, v1, a1, 0}, slow);
    const PathState in_cell = fast.at(fast.duration() * unit(draw));
    const double peak = v1 + 0.5 * a1 * a1 / slow.jerk, u = in_cell.ds;
    const double product =
        std::min(largest_stop_product(peak, slow.accel, slow.jerk), u * slow.accel);
    std::array<Row, 5> rows;
    piece.rest_stop_accel = piece.rest_stop_jerk = 1e12;
    for (Row& r : rows) {
      r = {std::pow(10, -3 + 4 * unit(draw)), std::pow(10, -3 + 4 * unit(draw)),
           std::pow(10, -4 + 4 * unit(draw)), 0, 0};
      r.accel = r.d1 * slow.accel + r.d2 * u * u;
      r.jerk = r.d1 * slow.jerk + 3 * r.d2 * product + r.d3 * u * u * u;
      piece.rest_stop_accel = std::min(piece.rest_stop_accel, r.accel / r.d1);
      piece.rest_stop_jerk = std::min(piece.rest_stop_jerk, r.jerk / r.d1);
    }
    const double x = unit(draw);
    const PathState begin{0, x * v1, x * x * a1, 0};
    const StopMargin got = authority_of(piece, StopKind::kHold, begin);
    const StopLaw law(begin, got);
    for (int k = 0; k <= 100; ++k) {
      const PathState at = law.at(law.duration() * k / 100);
      if (at.s < in_cell.s) continue;
      const double v = at.ds, depth = std::abs(at.dds);
      for (const Row& r : rows) {
        ASSERT_LE(r.d1 * depth + r.d2 * v * v, r.accel * (1 + 1e-9)) << n << " at " << x;
        ASSERT_LE(r.d1 * got.jerk + 3 * r.d2 * v * depth + r.d3 * v * v * v, r.jerk * (1 + 1e-9))
            << n << " at " << x;
      }
    }
    used += got.jerk > 1.01 * slow.jerk;
  }
  EXPECT_GT(used, test::draws(1000));
}

TEST(StopMargin, IsWhatThePlanSaysAtThePlannedSpeedOrWhereNothingIsKnown) {
  TimePiece piece;
  piece.stop_accel = 100;
  piece.stop_jerk = 1000;
  piece.fault_accel = 200;
  piece.fault_jerk = 4000;
  const PathState slow{0, 1, 0, 0};
  EXPECT_EQ(authority_of(piece, StopKind::kHold, slow).accel, 100);
  EXPECT_EQ(authority_of(piece, StopKind::kFault, slow).jerk, 4000);
  piece.authority_velocity = 1;
  piece.rest_stop_accel = 500;
  piece.rest_stop_jerk = 5000;
  EXPECT_EQ(authority_of(piece, StopKind::kHold, slow).jerk, 1000);
}

}  // namespace
}  // namespace meridian::test::stop_margin
