// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/free_spline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "meridian/planner/joints_at.hpp"

namespace meridian::test::free_spline {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

/// Spans of 1.3 mm each.
struct Spans : SpanLookup {
  [[nodiscard]] const BandSpan& span_at(double u) const noexcept override {
    span.length = 1.3;
    span.u0 = 1.3 * std::floor(u / 1.3);
    return span;
  }
  mutable BandSpan span;
};

/// A corridor over 40 mm of u, a node every half millimetre, 50 mm/s.
struct Corridor {
  template <class Low, class High>
  Corridor(const Low& low, const High& high) {
    for (int n = 0; n <= 80; ++n) {
      PoleWalls::Node node;
      node.u = 0.5 * n;
      node.t = node.u / 50;
      nodes.push_back(node);
      windows.push_back({node.t, low(node.u), high(node.u)});
    }
  }
  bool fit(const FreeEnd& begin, const FreeEnd& end, const FreeSpline::Shape& shape) {
    return spline.fit(spans, nodes, windows, begin, end, shape);
  }
  [[nodiscard]] double value_at(double u) const {
    for (std::size_t n = 0; n < spline.size(); ++n) {
      const PoleZone piece = spline.piece(n);
      if (u > piece.end && n + 1 < spline.size()) continue;
      return quintic_at(piece.free, (u - piece.begin) / (piece.end - piece.begin));
    }
    return 0;
  }
  /// Pieces that follow one another from the first node to the last with two derivatives.
  void expect_smooth() const {
    double u = 0, value = 0, d1 = 0, d2 = 0;
    for (std::size_t n = 0; n < spline.size(); ++n) {
      const PoleZone piece = spline.piece(n);
      const FreeQuintic& c = piece.free;
      const double h = piece.end - piece.begin;
      ASSERT_GT(h, 0);
      EXPECT_EQ(piece.begin, u) << n;
      if (n > 0) {
        EXPECT_NEAR(c[0], value, 1e-12) << n;
        EXPECT_NEAR(5 * (c[1] - c[0]) / h, d1, 1e-9) << n;
        EXPECT_NEAR(20 * (c[2] - 2 * c[1] + c[0]) / (h * h), d2, 1e-7) << n;
      }
      u = piece.end;
      value = c[5];
      d1 = 5 * (c[5] - c[4]) / h;
      d2 = 20 * (c[5] - 2 * c[4] + c[3]) / (h * h);
    }
    EXPECT_EQ(u, 40);
  }
  void expect_inside() const {
    for (int n = 0; n <= 4000; ++n) {
      const double u = 0.01 * n;
      const auto left = static_cast<std::size_t>(std::min(79.0, std::floor(u / 0.5)));
      const double low = std::min(windows[left].low, windows[left + 1].low);
      const double high = std::max(windows[left].high, windows[left + 1].high);
      EXPECT_GE(value_at(u), low - 1e-12) << u;
      EXPECT_LE(value_at(u), high + 1e-12) << u;
    }
  }
  /// ∫ (d²/du²)².
  [[nodiscard]] double bend() const {
    double sum = 0;
    for (int n = 1; n < 400; ++n) {
      const double u = 0.1 * n;
      const double second = (value_at(u - 0.05) - 2 * value_at(u) + value_at(u + 0.05)) / 0.0025;
      sum += 0.1 * second * second;
    }
    return sum;
  }

  Spans spans;
  std::vector<PoleWalls::Node> nodes;
  std::vector<StringWindow> windows;
  FreeSpline spline;
};

/// Anywhere but for a chicane: above 1 from 12 to 16, below -1 from 24 to 28.
Corridor chicane() {
  return {[](double u) { return u >= 12 && u <= 16 ? 1.0 : -5.0; },
          [](double u) { return u >= 24 && u <= 28 ? -1.0 : 5.0; }};
}

const FreeEnd kZero{{0, 0, 0}, 1}, kFlat{{0, 0, 0}, 3};

TEST(FreeSpline, IsAStraightLineWhereNothingIsInItsWay) {
  Corridor open([](double) { return -kAny; }, [](double) { return kAny; });
  ASSERT_TRUE(open.fit({{1, 0, 0}, 1}, {{5, 0, 0}, 1}, {4, 0.5, 0, 0}));
  open.expect_smooth();
  for (int n = 0; n <= 40; ++n) EXPECT_NEAR(open.value_at(n), 1 + 0.1 * n, 1e-9);
  EXPECT_EQ(open.spline.size(), 10U) << "as few pieces as gaps allow";
}

TEST(FreeSpline, StaysInsideTheCorridor) {
  for (const int sweeps : {0, 30}) {
    Corridor path = chicane();
    ASSERT_TRUE(path.fit(kFlat, kFlat, {4, 0.5, 0, sweeps}));
    path.expect_smooth();
    path.expect_inside();
  }
  Corridor narrow([](double u) { return 2 * std::sin(0.15 * u) - 0.5; },
                  [](double u) { return 2 * std::sin(0.15 * u) + 0.5; });
  ASSERT_TRUE(narrow.fit({{0, 0, 0}, 1}, {{2 * std::sin(6), 0, 0}, 1}, {4, 0.3, 0, 10}));
  narrow.expect_smooth();
  narrow.expect_inside();
  EXPECT_GT(narrow.spline.size(), 20U) << "knots are as close as the corridor is bent";
}

TEST(FreeSpline, BeginsAndEndsAsItsEndsSay) {
  Corridor path = chicane();
  ASSERT_TRUE(path.fit({{0.3, 0.2, -0.1}, 3}, {{-0.4, 0.15, 0.05}, 3}, {4, 0.5, 0, 20}));
  path.expect_smooth();
  const PoleZone first = path.spline.piece(0), last = path.spline.piece(path.spline.size() - 1);
  const double h = first.end - first.begin, k = last.end - last.begin;
  EXPECT_NEAR(first.free[0], 0.3, 1e-12);
  EXPECT_NEAR(5 * (first.free[1] - first.free[0]) / h, 0.2, 1e-9);
  EXPECT_NEAR(20 * (first.free[2] - 2 * first.free[1] + first.free[0]) / (h * h), -0.1, 1e-8);
  EXPECT_NEAR(last.free[5], -0.4, 1e-12);
  EXPECT_NEAR(5 * (last.free[5] - last.free[4]) / k, 0.15, 1e-9);
  EXPECT_NEAR(20 * (last.free[5] - 2 * last.free[4] + last.free[3]) / (k * k), 0.05, 1e-8);
  ASSERT_TRUE(path.fit({{0.7, 0, 0}, 1}, {{0, 0, 0}, 0}, {4, 0.5, 0, 0}));
  EXPECT_NEAR(path.value_at(0), 0.7, 1e-12);
  EXPECT_NEAR(path.value_at(40), -1, 1e-9) << "anything: the flattest end";
}

TEST(FreeSpline, IsTheRounderTheMoreItIsRelaxed) {
  Corridor taut = chicane(), round = chicane(), rounder = chicane();
  ASSERT_TRUE(taut.fit(kFlat, kFlat, {2, 0.5, 0, 0}));
  ASSERT_TRUE(round.fit(kFlat, kFlat, {2, 0.5, 0, 5}));
  ASSERT_TRUE(rounder.fit(kFlat, kFlat, {2, 0.5, 0, 100}));
  EXPECT_LT(round.bend(), 0.8 * taut.bend());
  EXPECT_LT(rounder.bend(), 0.8 * round.bend());
  EXPECT_NEAR(taut.value_at(20), 0, 0.3) << "straight from bend to bend";
}

TEST(FreeSpline, ItsStringTouchesTheCorridorWhereItBends) {
  Corridor path = chicane();
  ASSERT_TRUE(path.fit(kZero, kZero, {2, 0.5, 0, 0}));
  double largest = 0, smallest = 0;
  for (int n = 0; n <= 400; ++n) {
    largest = std::max(largest, path.value_at(0.1 * n));
    smallest = std::min(smallest, path.value_at(0.1 * n));
  }
  EXPECT_NEAR(largest, 1, 0.05);
  EXPECT_NEAR(smallest, -1, 0.05);
}

TEST(FreeSpline, HasNoMorePiecesThanThereIsRoomFor) {
  Corridor open([](double) { return -1.0; }, [](double) { return 1.0; });
  EXPECT_FALSE(open.fit(kZero, kZero, {0.07, 0.5, 0, 0}));
  EXPECT_TRUE(open.fit(kZero, kZero, {0.09, 0.5, 0, 0}));
  EXPECT_TRUE(open.fit(kZero, kZero, {100, 0.5, 0, 0}));
  EXPECT_EQ(open.spline.size(), 8U);
  open.expect_smooth();
}

TEST(FreeSpline, PutsKnotsOnEndsOfSpansThatAreClose) {
  Corridor open([](double) { return -1.0; }, [](double) { return 1.0; });
  ASSERT_TRUE(open.fit(kZero, kZero, {2.0, 0.5, 0, 0}));
  open.expect_smooth();
  int on = 0;
  for (std::size_t n = 1; n < open.spline.size(); ++n) {
    const double u = open.spline.piece(n).begin;
    const double off = std::abs(std::remainder(u, 1.3));
    EXPECT_TRUE(off < 1e-9 || off >= 0.05 * 2.0 - 1e-9) << u;
    on += off < 1e-9;
  }
  EXPECT_GT(on, 1);
}

TEST(FreeSpline, LetsGapsGrowGentlyFromWhereTheCorridorIsNarrow) {
  // From 0 to 1 between 18 and 22, 0.25 to either side.
  const auto middle = [](double u) { return std::clamp((u - 18) / 4, 0.0, 1.0); };
  Corridor step([&](double u) { return middle(u) - 0.25; },
                [&](double u) { return middle(u) + 0.25; });
  ASSERT_TRUE(step.fit({{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {4, 0.4, 0, 0}));
  step.expect_smooth();
  double shortest = kAny, at = 0;
  for (std::size_t n = 0; n < step.spline.size(); ++n) {
    const PoleZone piece = step.spline.piece(n);
    if (piece.end - piece.begin < shortest) at = 0.5 * (piece.begin + piece.end);
    shortest = std::min(shortest, piece.end - piece.begin);
    if (n == 0) continue;
    const PoleZone before = step.spline.piece(n - 1);
    const double ratio = (piece.end - piece.begin) / (before.end - before.begin);
    EXPECT_LT(std::max(ratio, 1 / ratio), 3) << piece.begin;
  }
  EXPECT_LT(shortest, 2);
  EXPECT_NEAR(at, 20, 4);
}

}  // namespace
}  // namespace meridian::test::free_spline
