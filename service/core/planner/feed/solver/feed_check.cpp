// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/feed_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "service/core/planner/feed/solver/parabola.hpp"

namespace meridian {
namespace {

constexpr int kCellSteps = FeedCell::kSteps;
constexpr double kNoBound = 1e9;
using Samples = std::array<double, kCellSteps + 1>;

/// A cubic leaves the parabola through three of its samples by no more than that of its third
/// difference: 1 / (9 √3), about.
constexpr double kOfThird = 0.0642;

/// By how much a function may rise above the parabola about sample `k`, by its third differences.
double rise_above(const Samples& f, int k) noexcept {
  const auto third = [&f](int n) {
    return std::abs(f[n + 3] - 3 * f[n + 2] + 3 * f[n + 1] - f[n]);
  };
  return kOfThird * std::min(third(std::max(k - 2, 0)), third(std::min(k - 1, kCellSteps - 3)));
}

/// Largest |f| of a smooth function from its samples: between them a peak rises to about the top of
/// the parabola through the three samples around it; beside the first or the last one, through the
/// three there.
double peak_of(const Samples& f) noexcept {
  double largest = 0;
  for (int k = 0; k <= kCellSteps; ++k) largest = std::max(largest, std::abs(f[k]));
  for (int k = 1; k < kCellSteps; ++k) {
    const double sign = f[k] < 0 ? -1 : 1;
    const Parabola about(sign * f[k - 1], sign * f[k], sign * f[k + 1]);
    const double before = k == 1 ? 2 : 1, after = k == kCellSteps - 1 ? 2 : 1;  // half samples
    const bool has_top = about.bend > 0 && !(-about.slope > before * about.bend) &&
                         !(about.slope > after * about.bend);
    if (has_top) largest = std::max(largest, about.top() + rise_above(f, k));
  }
  return largest;
}

/// Whether the law stands still inside the cell.
bool comes_to_rest(const CellLaw& law, double second, double h) noexcept {
  const bool has_minimum = second > 0 && law.slope < 0 && -law.slope < second * h;
  return has_minimum && !(2 * law.b * second > law.slope * law.slope);
}

/// `b` is u̇² at the samples.
FeedUse use_of_motion(const FeedLimits& limits, const FeedCell& cell, const CellMotion& motion,
                      const Samples& b) noexcept {
  const auto& [v, a, j] = motion;
  const RateRoom acceleration_room = limits.acceleration_room(), jerk_room = limits.jerk_room();
  FeedUse use;
  Samples share;
  for (int k = 0; k <= kCellSteps; ++k) share[k] = b[k] / cell.at[k].max_b;
  use.b = peak_of(share);
  for (int i = 0; i < limits.count; ++i) {
    Samples velocity, alone, acceleration, own_jerk, jerk;
    for (int k = 0; k <= kCellSteps; ++k) {
      const CellSample& at = cell.at[k];
      velocity[k] = at.d1[i] * v[k];
      alone[k] = at.d1[i] * a[k] + at.d2[i] * b[k];
      acceleration[k] = acceleration_room.largest(std::abs(alone[k]), std::abs(velocity[k]));
      own_jerk[k] = at.d1[i] * j[k] + 3 * at.d2[i] * v[k] * a[k] + at.d3[i] * v[k] * b[k];
      jerk[k] = jerk_room.largest(std::abs(own_jerk[k]), 3 * std::abs(alone[k])) +
                limits.curvature * std::abs(velocity[k]);
    }
    const double fastest = peak_of(velocity);
    double largest = peak_of(jerk);
    // Beside a corner of |jerk| or |acceleration| a parabola rises too far: there the peaks of the
    // parts speak.
    if (largest > limits.full_jerk[i]) {
      largest = std::min(largest, jerk_room.largest(peak_of(own_jerk), 3 * peak_of(alone)) +
                                      limits.curvature * fastest);
    }
    use.velocity = std::max(use.velocity, fastest / limits.velocity[i]);
    use.acceleration = std::max(use.acceleration, peak_of(acceleration) / limits.acceleration[i]);
    use.jerk = std::max(use.jerk, largest / limits.full_jerk[i]);
  }
  return use;
}

}  // namespace

FeedUse use_of(const FeedLimits& limits, const FeedCell& cell, const CellLaw& law) noexcept {
  FeedUse none;
  none.jerk = kNoBound;
  const double second = (law.slope_end - law.slope) / cell.h;
  if (comes_to_rest(law, second, cell.h)) return none;
  CellMotion motion;
  Samples b;
  for (int k = 0; k <= kCellSteps; ++k) {
    const double x = cell.h * k / kCellSteps;
    b[k] = law.b + x * (law.slope + 0.5 * second * x);
    if (!(b[k] > 0)) return none;
    motion.v[k] = std::sqrt(b[k]);
    motion.a[k] = 0.5 * (law.slope + second * x);
    motion.j[k] = 0.5 * second * motion.v[k];
  }
  return use_of_motion(limits, cell, motion, b);
}

FeedUse max_use_of(const FeedLimits& limits, const FeedCell& cell, const CellLaw& law) noexcept {
  const double second = (law.slope_end - law.slope) / cell.h;
  const double middle = law.b + 0.5 * law.slope * cell.h;  // b is within its Bézier points
  const double end = middle + 0.5 * law.slope_end * cell.h;
  FeedUse use;
  if (!(std::min({law.b, middle, end}) > 0)) {
    use.jerk = kNoBound;
    return use;
  }
  const double b = std::max({law.b, middle, end}), v = std::sqrt(b);
  const double a = 0.5 * std::max(std::abs(law.slope), std::abs(law.slope_end));
  const double j = 0.5 * std::abs(second) * v;
  use.b = b / cell.max_b;
  const RateRoom acceleration_room = limits.acceleration_room(), jerk_room = limits.jerk_room();
  const CellBound& bound = cell.bound;
  for (int i = 0; i < limits.count; ++i) {
    const double d1 = bound.rate[i], d2 = std::max(bound.d2.up[i], bound.d2.down[i]);
    const double d3 = std::max(bound.d3.up[i], bound.d3.down[i]);
    const double velocity = d1 * v, alone = d1 * a + d2 * b;
    const double jerk = jerk_room.largest(d1 * j + 3 * d2 * v * a + d3 * v * b, 3 * alone) +
                        limits.curvature * velocity;
    use.velocity = std::max(use.velocity, velocity / limits.velocity[i]);
    use.acceleration = std::max(
        use.acceleration, acceleration_room.largest(alone, velocity) / limits.acceleration[i]);
    use.jerk = std::max(use.jerk, jerk / limits.full_jerk[i]);
  }
  return use;
}

FeedUse use_of_motion(const FeedLimits& limits, const FeedCell& cell,
                      const CellMotion& motion) noexcept {
  Samples b;
  for (int k = 0; k <= kCellSteps; ++k) b[k] = motion.v[k] * motion.v[k];
  return use_of_motion(limits, cell, motion, b);
}

void add_use(const FeedLimits& limits, const CellSample& at, double v, double a, double j,
             FeedUse& use) noexcept {
  const RateRoom acceleration_room = limits.acceleration_room(), jerk_room = limits.jerk_room();
  use.b = std::max(use.b, v * v / at.max_b);
  for (int i = 0; i < limits.count; ++i) {
    const double velocity = std::abs(at.d1[i] * v);
    const double acceleration = std::abs(at.d1[i] * a + at.d2[i] * v * v);
    const double own_jerk = std::abs(at.d1[i] * j + 3 * at.d2[i] * v * a + at.d3[i] * v * v * v);
    const double jerk = jerk_room.largest(own_jerk, 3 * acceleration) + limits.curvature * velocity;
    use.velocity = std::max(use.velocity, velocity / limits.velocity[i]);
    use.acceleration =
        std::max(use.acceleration,
                 acceleration_room.largest(acceleration, velocity) / limits.acceleration[i]);
    use.jerk = std::max(use.jerk, jerk / limits.full_jerk[i]);
  }
}

}  // namespace meridian
