// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/join_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/machines.hpp"

namespace meridian::certify {
namespace {

/// A piece of 0.1 s that ends, and the next begins, with joint 0 so.
[[nodiscard]] PieceVerdict piece_of(double q, double v, double a, double bound = 0.5) {
  PieceVerdict piece;
  piece.begin.q[0].set(0, q);
  piece.begin.q[0].set(1, v);
  piece.begin.q[0].set(2, 0.5 * a);
  piece.end = piece.begin;
  for (auto& orders : piece.joint_bound) orders = {bound, bound, bound};
  return piece;
}

TEST(JoinCheck, LetsPiecesMeetThatMeet) {
  const MachineModel model = test::bench_machine();
  JoinCheck joins(model);
  for (int n = 0; n < 5; ++n) EXPECT_TRUE(joins.go_on(piece_of(3, 20, 100), 0.1, false).is_joined);
  EXPECT_FALSE(joins.rest().is_joined);  // moving
}

TEST(JoinCheck, FindsAJumpOfEveryOrder) {
  const MachineModel model = test::bench_machine();  // 1 ms: 300 mm/s, 3000 mm/s², 60000 mm/s³
  for (const auto& [q, v, a] : {std::array{3 + 1e-4, 20.0, 100.0}, std::array{3.0, 20.1, 100.0},
                                std::array{3.0, 20.0, 160.0}}) {
    JoinCheck joins(model);
    (void)joins.go_on(piece_of(3, 20, 100), 0.1, false);
    const JoinCheck::Verdict verdict = joins.go_on(piece_of(q, v, a), 0.1, false);
    EXPECT_FALSE(verdict.is_joined);
    EXPECT_EQ(verdict.broken.quantity, Quantity::kJerk);
    EXPECT_EQ(verdict.broken.joint, 0);
  }
}

TEST(JoinCheck, AllowsAJumpThatHasRoomBesideThePieces) {
  const MachineModel model = test::bench_machine();
  const double step = 0.2 * 60000 * 1e-3 / 0.75;  // of the acceleration: a fifth of the jerk
  for (const double bound : {0.7, 0.9}) {
    JoinCheck joins(model);
    (void)joins.go_on(piece_of(3, 20, 100, bound), 0.1, false);
    const auto verdict = joins.go_on(piece_of(3, 20, 100 + step, bound), 0.1, false);
    EXPECT_NEAR(verdict.worst[2].share, 0.2, 1e-6);
    EXPECT_EQ(verdict.is_joined, bound < 0.8);
  }
}

TEST(JoinCheck, AddsUpTheJumpsThatOneDifferenceSees) {
  const MachineModel model = test::bench_machine();
  const double step = 0.2 * 60000 * 1e-3 / 0.75;
  JoinCheck near(model), far(model);
  for (int n = 0; n < 3; ++n) {
    const auto close = near.go_on(piece_of(3, 20, 100 + step * n, 0.7), 1e-3, false);
    const auto apart = far.go_on(piece_of(3, 20, 100 + step * n, 0.7), 4e-3, false);
    EXPECT_EQ(close.is_joined, n < 2) << n;
    EXPECT_TRUE(apart.is_joined);
  }
}

/// The weights in join_check.hpp: differences of a jump of each order, sampled at any phase.
TEST(JoinCheck, BoundsTheDifferencesOfAJump) {
  const double max[3][3] = {{1, 0, 0}, {1, 1, 0}, {2, 1, 0.75}};  // [difference - 1][jump]
  for (int jump = 0; jump < 3; ++jump) {
    double largest[3] = {0, 0, 0};
    for (int phase = 0; phase <= 1000; ++phase) {
      double q[7];
      for (int n = 0; n < 7; ++n) {
        const double t = n - 3 + 1e-3 * phase;  // in cycles
        q[n] = t < 0 ? 0 : jump == 0 ? 1 : jump == 1 ? t : 0.5 * t * t;
      }
      for (int n = 3; n < 7; ++n) {
        const double d1 = q[n] - q[n - 1], d2 = d1 - q[n - 1] + q[n - 2];
        const double d3 = q[n] - 3 * q[n - 1] + 3 * q[n - 2] - q[n - 3];
        // what a derivative of the order of the difference would make of it is no jump's
        largest[0] = std::max(largest[0], jump < 1 ? std::abs(d1) : 0.0);
        largest[1] = std::max(largest[1], jump < 2 ? std::abs(d2) : 0.0);
        largest[2] = std::max(largest[2], std::abs(d3));
      }
    }
    for (int order = 0; order < 3; ++order) {
      EXPECT_LE(largest[order], max[order][jump] + 1e-9) << "jump " << jump << ", " << order + 1;
      EXPECT_GE(largest[order], max[order][jump] - 1e-5) << "jump " << jump << ", " << order + 1;
    }
  }
}

TEST(JoinCheck, CountsWholeTurnsBetweenPathsAndNotOnOne) {
  const MachineModel model = test::bench_machine();
  const auto turned = [](double c) {
    PieceVerdict piece = piece_of(3, 20, 100);
    piece.begin.q[3].set(0, c);
    piece.end = piece.begin;
    return piece;
  };
  for (const bool is_same_path : {true, false}) {
    JoinCheck joins(model);
    (void)joins.go_on(turned(3), 0.1, false);
    EXPECT_EQ(joins.go_on(turned(3 - 2 * std::numbers::pi), 0.1, is_same_path).is_joined,
              is_same_path);
  }
}

}  // namespace
}  // namespace meridian::certify
