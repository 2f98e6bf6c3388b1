// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "service/core/planner/feed/solver/feed_check.hpp"

namespace meridian {
namespace {

constexpr double kRestShare = 0.92;  // of the limits in a first or last cell
constexpr double kRestStep = 0.7;    // of the ladder
constexpr int kRestSteps = 120;
constexpr int kRestHalvings = 4;       // of its last step
constexpr double kCrawlMargin = 1.02;  // on the duration: limits between samples

/// The least duration of a crawl over `length` that keeps the jerk and what comes with it at a
/// sample of a cell, where it has `shape` with the jerk `j`; no less than `duration`.
double duration_at(const FeedLimits& limits, double tight, const CellSample& at, double length,
                   const Crawl::Shape& shape, double j, double duration) noexcept {
  const double v = length * shape.v, a = length * shape.a;
  for (int i = 0; i < limits.count; ++i) {
    const double speed = std::abs(at.d1[i] * v) / limits.velocity[i];
    const double jerk = std::abs(at.d1[i] * j + 3 * at.d2[i] * v * a + at.d3[i] * v * v * v) /
                        (tight * limits.jerk[i]);
    const double accel = std::abs(at.d1[i] * a + at.d2[i] * v * v) / limits.acceleration[i];
    // accel/T² + filter/T <= 1
    const double filter = limits.slope * std::abs(at.d1[i] * v) / limits.acceleration[i];
    const double by_accel = 0.5 * (filter + std::sqrt(filter * filter + 4 * accel));
    duration = std::max(duration, kCrawlMargin * std::max({speed, by_accel, std::cbrt(jerk)}));
  }
  return duration;
}

}  // namespace

double steady_b(const CellGrid& grid, const FeedLimits& limits, std::int64_t first,
                std::int64_t last) noexcept {
  double largest = std::numeric_limits<double>::infinity();
  for (std::int64_t cell = first; cell < last; ++cell) {
    for (int k = 0; k <= FeedCell::kSteps; k += FeedCell::kSteps / 2) {
      const CellSample& at = grid[cell].at[k];
      largest = std::min(largest, at.max_b);
      for (int i = 0; i < limits.count; ++i) {
        const double d2 = std::max(std::abs(at.d2[i]), kZeroDerivative);
        const double d3 = std::max(std::abs(at.d3[i]), kZeroDerivative);
        largest = std::min({largest, kCurvatureShare * limits.acceleration[i] / d2,
                            kCurvatureShare * std::pow(limits.jerk[i] / d3, 2.0 / 3.0)});
      }
    }
  }
  return largest;
}

RestCell find_rest_cell(const FeedLimits& limits, const FeedCell& cell, bool is_start, double max_b,
                        RestRoom room) noexcept {
  const double h = cell.h;
  const FeedLimits without_rate = limits.without_rate();
  const CellSample& rest = is_start ? cell.at.front() : cell.at.back();
  const auto is_within = [&](double jerk) {
    FeedUse use;
    for (int k = 0; k <= FeedCell::kSteps; ++k) {
      const double x = h * k / FeedCell::kSteps;
      const double t = std::cbrt(6 * x / jerk);
      const double a = is_start ? jerk * t : -jerk * t;
      const int sample = is_start ? k : FeedCell::kSteps - k;
      const double v = 0.5 * jerk * t * t;
      add_use(limits, cell.at[sample], v, a, jerk, use);
      if (room == RestRoom::kLargest) add_use(without_rate, cell.at[sample], v, a, jerk, use);
    }
    return use.worst() < kRestShare * cell.tight && use.b < kRestShare;
  };
  // b = (j t²/2)² at t = (6h/j)^⅓ is (6h)^(4/3) j^(2/3) / 4.
  double jerk = std::pow(0.8 * std::max(max_b, kZeroDerivative), 1.5) / (36 * h * h);
  for (int i = 0; i < limits.count; ++i) {
    jerk = std::min(
        jerk, kRestShare * limits.full_jerk[i] / std::max(std::abs(rest.d1[i]), kZeroDerivative));
  }
  double too_much = 0;
  for (int n = 0; n < kRestSteps && !is_within(jerk); ++n) {
    too_much = jerk;
    jerk *= kRestStep;
  }
  for (int n = 0; n < kRestHalvings && too_much > 0; ++n) {
    const double between = std::sqrt(jerk * too_much);
    (is_within(between) ? jerk : too_much) = between;
  }
  const double t = std::cbrt(6 * h / jerk), v = 0.5 * jerk * t * t;
  return {{v * v, 2 * jerk * t}, t, jerk};
}

Crawl::Shape Crawl::shape_at(double x) noexcept {
  constexpr double kJerk = 32;
  if (x > 0.5) {
    const Shape mirror = shape_at(1 - x);
    return {1 - mirror.t, mirror.v, -mirror.a, x < 11.0 / 12 ? -kJerk : kJerk};
  }
  if (x < 1.0 / 12) {
    const double t = std::cbrt(6 * std::max(x, 0.0) / kJerk);
    return {t, 0.5 * kJerk * t * t, kJerk * t, kJerk};
  }
  // Second phase, seen from its end at t = ½, x = ½, where ü = 0 and u̇ = 2: Newton for
  // ½ - x = 2 r - 16 r³/3 with r = ½ - t.
  double r = 0.5 * (0.5 - x);
  for (int n = 0; n < 30; ++n) {
    const double step = (0.5 - x - 2 * r + kJerk * r * r * r / 6) / (2 - 0.5 * kJerk * r * r);
    r = std::min(r + step, 0.25);
    if (std::abs(step) < 1e-17) break;
  }
  return {0.5 - r, 2 - 0.5 * kJerk * r * r, kJerk * r, -kJerk};
}

Crawl crawl_over(const CellGrid& grid, const FeedLimits& limits, std::int64_t first,
                 int cells) noexcept {
  Crawl crawl{cells, 0, 1e-3};
  for (int n = 0; n < cells; ++n) crawl.length += grid[first + n].h;
  double begin = 0;
  for (int n = 0; n < cells; ++n) {
    const FeedCell& cell = grid[first + n];
    for (int k = 0; k <= FeedCell::kSteps; ++k) {
      const double x = (begin + cell.h * k / FeedCell::kSteps) / crawl.length;
      const Crawl::Shape shape = Crawl::shape_at(std::min(x, 1.0));
      const double v = crawl.length * shape.v;
      const CellSample& at = cell.at[k];
      crawl.duration = std::max(crawl.duration, kCrawlMargin * v / std::sqrt(at.max_b));
      for (const double j : {crawl.length * shape.j, -crawl.length * shape.j}) {
        crawl.duration =
            duration_at(limits, cell.tight, at, crawl.length, shape, j, crawl.duration);
      }
    }
    begin += cell.h;
  }
  return crawl;
}

FeedUse use_of(const FeedLimits& limits, const CellGrid& grid, std::int64_t first,
               const Crawl& crawl) noexcept {
  const double d = crawl.length, t = crawl.duration;
  FeedUse use;
  double begin = 0;
  for (int n = 0; n < crawl.cells; ++n) {
    const FeedCell& cell = grid[first + n];
    // The jerk changes its sign inside cells: either one is taken for the whole of each.
    for (const double sign : {-1.0, 1.0}) {
      CellMotion motion;
      for (std::size_t k = 0; k < motion.v.size(); ++k) {
        const double x = (begin + cell.h * static_cast<double>(k) / FeedCell::kSteps) / d;
        const Crawl::Shape shape = Crawl::shape_at(std::min(x, 1.0));
        motion.v[k] = d * shape.v / t;
        motion.a[k] = d * shape.a / (t * t);
        motion.j[k] = sign * d * std::abs(shape.j) / (t * t * t);
      }
      const FeedUse here = use_of_motion(limits, cell, motion);
      use.velocity = std::max(use.velocity, here.velocity);
      use.acceleration = std::max(use.acceleration, here.acceleration);
      use.jerk = std::max(use.jerk, here.jerk);
      use.b = std::max(use.b, here.b);
    }
    begin += cell.h;
  }
  return use;
}

Crawl checked(const FeedLimits& limits, const CellGrid& grid, std::int64_t first,
              Crawl crawl) noexcept {
  const FeedUse use = use_of(limits, grid, first, crawl);
  // Acceleration is made up of 1/T², and of 1/T for the rate filter.
  const double slower =
      std::max({use.velocity, use.acceleration, std::cbrt(use.jerk), std::sqrt(use.b)});
  if (slower > 1) crawl.duration *= slower;
  return crawl;
}

}  // namespace meridian
