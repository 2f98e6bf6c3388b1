// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/taut_string.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace meridian {
namespace {

/// Drawn windows about a value that wanders.
std::vector<StringWindow> drawn(std::mt19937& engine) {
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  std::vector<StringWindow> windows;
  double t = 0, middle = 0;
  for (int n = 0; n < 50; ++n) {
    const double half = uniform(0.05, 2);
    windows.push_back({t, middle - half, middle + half});
    t += uniform(0.5, 1.5);
    middle += std::normal_distribution<double>(0, 1)(engine);
  }
  return windows;
}

/// Of one step: no faster than `speed`, and no less than the time between the windows.
double step_time(double dt, double by, double speed) { return std::max(dt, std::abs(by) / speed); }

/// The least time through the windows on a grid of `step`, by dynamic programming.
double min_time(const std::vector<StringWindow>& windows, double begin, double speed, double step) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const int count = static_cast<int>(30 / step);
  const auto value = [&](int i) { return begin + (i - count / 2) * step; };
  std::vector<double> best(static_cast<std::size_t>(count), kNever), next;
  best[static_cast<std::size_t>(count / 2)] = 0;
  for (std::size_t n = 1; n < windows.size(); ++n) {
    next.assign(static_cast<std::size_t>(count), kNever);
    for (int i = 0; i < count; ++i) {
      if (value(i) < windows[n].low || value(i) > windows[n].high) continue;
      for (int k = 0; k < count; ++k) {
        if (best[static_cast<std::size_t>(k)] == kNever) continue;
        const double time = best[static_cast<std::size_t>(k)] +
                            step_time(windows[n].t - windows[n - 1].t, (i - k) * step, speed);
        next[static_cast<std::size_t>(i)] = std::min(next[static_cast<std::size_t>(i)], time);
      }
    }
    best = next;
  }
  return *std::min_element(best.begin(), best.end());
}

TEST(TautString, IsTheFastestThroughDrawnWindowsAtEverySpeed) {
  std::mt19937 engine(7);
  for (int draw = 0; draw < 12; ++draw) {
    const auto windows = drawn(engine);
    std::vector<double> values(windows.size());
    pull_taut(windows, 0, values);
    ASSERT_EQ(values[0], 0);
    for (const double speed : {0.2, 0.7, 2.0}) {
      double time = 0;
      for (std::size_t n = 1; n < windows.size(); ++n) {
        ASSERT_GE(values[n], windows[n].low);
        ASSERT_LE(values[n], windows[n].high);
        time += step_time(windows[n].t - windows[n - 1].t, values[n] - values[n - 1], speed);
      }
      EXPECT_LE(time, min_time(windows, 0, speed, 0.1) + 1e-9) << "draw " << draw;
    }
  }
}

TEST(TautString, StaysWhereNothingAsksItToMove) {
  const std::vector<StringWindow> windows{{0, 1, 1}, {1, -1, 2}, {2, 0.5, 9}, {5, -3, 1}};
  std::vector<double> values(windows.size());
  pull_taut(windows, 1, values);
  EXPECT_EQ(values, std::vector<double>(4, 1.0));
}

TEST(TautString, GoesStraightToAFixedEndAndBendsAtTheWallsAlone) {
  const std::vector<StringWindow> windows{
      {0, 0, 0}, {1, -9, 9}, {2, -9, 0.5}, {3, -9, 9}, {4, 4, 4}};
  std::vector<double> values(windows.size());
  pull_taut(windows, 0, values);
  EXPECT_EQ(values, (std::vector<double>{0, 0.25, 0.5, 2.25, 4}));
}

TEST(TautString, PassesAnEmptyWindowInItsMiddle) {
  const std::vector<StringWindow> windows{{0, 0, 0}, {1, 3, 1}, {2, -9, 9}};
  std::vector<double> values(windows.size());
  pull_taut(windows, 0, values);
  EXPECT_EQ(values[1], 2);
}

}  // namespace
}  // namespace meridian
