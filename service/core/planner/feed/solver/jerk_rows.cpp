// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/jerk_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meridian {
namespace {

constexpr double kTiniest = 1e-300;

/// |q' b'/2 + q'' b| + per_b b <= limit, (8.6): what the rate filter leaves of an acceleration
/// `limit`, about b̄.
struct LimitLine {
  double per_b = 0, limit = 0;
};
LimitLine limit_line(const RateRoom& room, double limit, double d1, double bar) noexcept {
  const double root = std::sqrt(bar), rate = std::abs(d1);
  const auto [share, slope] = room.tangent(limit, rate * root);
  const double filter = slope * rate / share;
  return {filter / (2 * root), limit / share - 0.5 * filter * root};
}

}  // namespace

void bound_slope(const FeedLimits& limits, JerkCell& at) noexcept {
  const CellSample& sample = at.cell->at[0];
  const RateRoom room = limits.acceleration_room();
  at.max_slope = std::numeric_limits<double>::infinity();
  for (int j = 0; j < limits.count; ++j) {
    const double d1 = std::abs(sample.d1[j]);
    const double limit = limits.acceleration[j] * at.accel_share;
    const double left =
        limit_line(room, limit, d1, at.bar[0]).limit + std::abs(sample.d2[j]) * at.max_b[0];
    const double largest = 2 * left / std::max(d1, kTiniest);
    if (largest >= at.max_slope) continue;
    at.max_slope = largest;
    at.slope_joint = j;
  }
}

void JerkRows::add(const JerkCoefficients& a, double limit) noexcept {
  rows_[static_cast<std::size_t>(count_++)] = {a, limit};
}

void JerkRows::add_pair(const JerkCoefficients& value, const JerkCoefficients& rest,
                        double limit) noexcept {
  add({value[0] + rest[0], value[1] + rest[1], value[2] + rest[2]}, limit);
  add({rest[0] - value[0], rest[1] - value[1], rest[2] - value[2]}, limit);
}

void JerkRows::add_acceleration(const FeedLimits& limits, const JerkCell& at) noexcept {
  const CellSample& sample = at.cell->at[0];
  const RateRoom room = limits.acceleration_room();
  for (int j = 0; j < limits.count; ++j) {
    const double d1 = sample.d1[j], d2 = sample.d2[j];
    const LimitLine line = limit_line(room, limits.acceleration[j] * at.accel_share, d1, at.bar[0]);
    const double largest =
        0.5 * std::abs(d1) * at.max_slope + (std::abs(d2) + line.per_b) * at.max_b[0];
    if (largest <= line.limit && j != at.slope_joint) continue;
    JerkCoefficients value{}, rest{};
    for (std::size_t t = 0; t < 3; ++t) {
      value[t] = 0.5 * d1 * at.slope[t] + d2 * at.b[t];
      rest[t] = line.per_b * at.b[t];
    }
    add_pair(value, rest, line.limit);
  }
}

void JerkRows::add_jerk(const FeedLimits& limits, const JerkCell& at) noexcept {
  std::array<RowSample, 3> samples;
  const double h = at.cell->h;
  for (std::size_t p = 0; p < 3; ++p) {
    RowSample& sample = samples[p];
    const double x = 0.5 * static_cast<double>(p) * h;
    for (std::size_t t = 0; t < 3; ++t) {
      sample.bend[t] = (at.end[t] - at.slope[t]) / h;
      sample.slope[t] = at.slope[t] + sample.bend[t] * x;
      sample.b[t] = at.b[t] + at.slope[t] * x + 0.5 * sample.bend[t] * x * x;
    }
    sample.max_b = at.max_b[p];
    sample.bar = at.bar[p];
    sample.bar_slope = at.bar_slope[p];
    sample.at = &at.cell->at[p * FeedCell::kSteps / 2];
  }
  samples[0].max_slope = at.max_slope;
  samples[1].max_slope = std::max(at.max_slope, at.max_end);
  samples[2].max_slope = at.max_end;

  // Largest |b''|, which is the same all over the cell, and by which row.
  const RateRoom room = limits.jerk_room();
  std::array<std::array<JerkLine, kMaxLimited>, 3> lines;
  double max_bend = std::numeric_limits<double>::infinity();
  std::size_t bend_sample = 0;
  int bend_joint = -1;
  for (std::size_t p = 0; p < 3; ++p) {
    const RowSample& sample = samples[p];
    for (int j = 0; j < limits.count; ++j) {
      const JerkLine& line = lines[p][j] = line_at(limits, room, sample, j, at.jerk_share);
      const double largest = (line.limit + rest_of(line, sample, j)) /
                             std::max(0.5 * std::abs(sample.at->d1[j]), kTiniest);
      if (largest >= max_bend) continue;
      max_bend = largest;
      bend_sample = p;
      bend_joint = j;
    }
  }
  for (std::size_t p = 0; p < 3; ++p) {
    const RowSample& sample = samples[p];
    for (int j = 0; j < limits.count; ++j) {
      const JerkLine& line = lines[p][j];
      const double d1 = sample.at->d1[j], d2 = sample.at->d2[j], d3 = sample.at->d3[j];
      const double largest =
          rest_of(line, sample, j) + line.per_b * sample.max_b + 0.5 * std::abs(d1) * max_bend;
      if (largest <= line.limit && (p != bend_sample || j != bend_joint)) continue;
      JerkCoefficients value{}, rest{};
      for (std::size_t t = 0; t < 3; ++t) {
        value[t] = d3 * sample.b[t] + 1.5 * d2 * sample.slope[t] + 0.5 * d1 * sample.bend[t];
        rest[t] = line.per_accel * (0.5 * d1 * sample.slope[t] + d2 * sample.b[t]) +
                  line.per_b * sample.b[t];
      }
      add_pair(value, rest, line.limit);
    }
  }
}

/// Largest value of what bears on a jerk row beside b'' and the tangent's b.
double JerkRows::rest_of(const JerkLine& line, const RowSample& sample, int j) noexcept {
  const double d1 = std::abs(sample.at->d1[j]), d2 = std::abs(sample.at->d2[j]);
  const double accel = 0.5 * d1 * sample.max_slope + d2 * sample.max_b;
  return std::abs(sample.at->d3[j]) * sample.max_b + 1.5 * d2 * sample.max_slope +
         std::abs(line.per_accel) * accel;
}

/// Of (8.3) over √b, with the ε that binds at b̄ and b̄' where both are known, the tangent about
/// them; else J less what A and V take of it.
JerkRows::JerkLine JerkRows::line_at(const FeedLimits& limits, const RateRoom& room,
                                     const RowSample& sample, int j, double share) noexcept {
  const double root = std::sqrt(sample.bar);
  const double per_b = 1 / (2 * sample.bar * root);
  if (std::isnan(sample.bar_slope)) {
    const double jerk = share * limits.jerk[j];
    return {0, jerk * per_b, 1.5 * jerk / root};
  }
  const double d1 = sample.at->d1[j], d2 = sample.at->d2[j];
  const double accel = 0.5 * d1 * sample.bar_slope + d2 * sample.bar;
  const double full = share * limits.full_jerk[j], curved = limits.curvature * std::abs(d1);
  const auto tangent = room.tangent(full - curved * root, 3 * std::abs(accel));
  const double jerk = full / tangent.share, slope = 3 * tangent.slope / tangent.share;
  return {std::copysign(slope / root, accel), std::max(0.0, jerk - slope * std::abs(accel)) * per_b,
          1.5 * jerk / root - curved / tangent.share - 0.5 * slope * std::abs(accel) / root};
}

void JerkRows::find(const FeedLimits& limits, const JerkCell& at) noexcept {
  count_ = 0;
  if (!at.is_first) {
    add_acceleration(limits, at);
    add(at.b, at.max_b[0]);
  }
  add_jerk(limits, at);
  add(at.middle, at.max_b[1]);
}

}  // namespace meridian
