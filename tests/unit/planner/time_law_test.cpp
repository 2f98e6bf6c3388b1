// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/time_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace meridian {
namespace {

TEST(TimeLaw, IsConstantJerkWithoutSpeedTerm) {
  TimePiece piece;
  piece.s0 = 1;
  piece.v = 2;
  piece.a = 3;
  piece.j = 6;
  const PathState state = state_at(piece, 0.5);
  EXPECT_DOUBLE_EQ(state.s, 1 + 1 + 0.375 + 0.125);
  EXPECT_DOUBLE_EQ(state.ds, 2 + 1.5 + 0.75);
  EXPECT_DOUBLE_EQ(state.dds, 6);
  EXPECT_DOUBLE_EQ(state.ddds, 6);
}

TEST(TimeLaw, SolvesTheOscillatorAndItsTwinToRounding) {
  for (const double k : {-4.0, -0.5, 0.5, 4.0}) {
    TimePiece piece;
    piece.v = 2;
    piece.a = -3;
    piece.j = 5;
    piece.k = k;
    const double t = 0.45, w = std::sqrt(std::abs(k));
    const double c = k > 0 ? std::cosh(w * t) : std::cos(w * t);
    const double s = k > 0 ? std::sinh(w * t) / w : std::sin(w * t) / w;
    const PathState state = state_at(piece, t);
    EXPECT_NEAR(state.s, 2 * s - 3 * (c - 1) / k + 5 * (s - t) / k, 1e-14) << k;
    EXPECT_NEAR(state.ds, 2 * c - 3 * s + 5 * (c - 1) / k, 1e-14) << k;
    EXPECT_NEAR(state.dds, 2 * k * s - 3 * c + 5 * s, 1e-14) << k;
    EXPECT_NEAR(state.ddds, 5 + k * state.ds, 1e-14) << k;
  }
}

TEST(TimeLaw, RestsOnPiecesThatDoNotMove) {
  TimePiece piece;
  piece.kind = TimeKind::kDwell;
  piece.s0 = 4;
  EXPECT_EQ(state_at(piece, 100.0).s, 4);
  EXPECT_EQ(state_at(piece, 100.0).ds, 0);
}

}  // namespace
}  // namespace meridian
