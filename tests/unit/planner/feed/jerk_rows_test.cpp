// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/jerk_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace meridian::test::jerk_rows {
namespace {

constexpr int kJoints = 3;

struct Drawn {
  FeedCell cell{};
  FeedLimits limits;
  JerkCell at;
};

/// A cell of even neighbours whose derivatives, limits and bar are drawn.
Drawn draw(unsigned seed) {
  std::mt19937 random(seed);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  Drawn out;
  out.limits.count = kJoints;
  out.limits.slope = real(0, 1);
  out.limits.curvature = real(0, 4);
  out.cell.h = real(0.2, 0.8);
  for (int j = 0; j < kJoints; ++j) {
    out.limits.acceleration[j] = real(20, 80);
    out.limits.jerk[j] = real(200, 2000);
    out.limits.full_jerk[j] = out.limits.jerk[j] + real(0, 400);
  }
  for (CellSample& sample : out.cell.at) {
    for (int j = 0; j < kJoints; ++j) {
      sample.d1[j] = real(-1, 1);
      sample.d2[j] = real(-0.6, 0.6);
      sample.d3[j] = real(-0.4, 0.4);
    }
  }
  const double h = out.cell.h;
  out.at.b = {0.5, 0.5, 0};
  out.at.slope = {-1 / h, 1 / h, 0};
  out.at.end = {0, -1 / h, 1 / h};
  out.at.middle = {0.125, 0.75, 0.125};
  out.at.bar = {real(20, 60), real(20, 60), real(20, 60)};
  out.at.max_b = {real(60, 90), real(60, 90), real(60, 90)};
  out.at.accel_share = real(0.7, 1);
  out.at.jerk_share = real(0.7, 1);
  out.at.max_slope = real(60, 400);
  out.at.max_end = real(60, 400);
  if (seed % 2 == 0) out.at.bar_slope = {real(-60, 60), real(-60, 60), real(-60, 60)};
  return out;
}

double product(const JerkCoefficients& a, const JerkCoefficients& c) {
  return a[0] * c[0] + a[1] * c[1] + a[2] * c[2];
}

/// fixed + per_b b + per_slope b'
struct JerkTangent {
  double fixed = 0, per_b = 0, per_slope = 0;
};

/// Of what joint `j` may have of l₃ at sample `p`, the tangent about b and b' there: what a and v
/// leave of the jerk where b' is known, else what A and V leave of it.
JerkTangent tangent_of(const Drawn& drawn, int j, std::size_t p) {
  const JerkCell& at = drawn.at;
  const CellSample& sample = drawn.cell.at[p * 4];
  const double bar = at.bar[p], slope = at.bar_slope[p], root = std::sqrt(bar);
  double jerk = drawn.limits.jerk[j] * at.jerk_share, per_slope = 0, filter_per_b = 0;
  double fixed = 1 / root;
  RateRoom::Line rate;
  if (!std::isnan(slope)) {
    const double accel = 0.5 * sample.d1[j] * slope + sample.d2[j] * bar;
    const double full = drawn.limits.full_jerk[j] * at.jerk_share;
    rate = RateRoom::of_jerk(drawn.limits.slope, drawn.limits.curvature)
               .tangent(full - drawn.limits.curvature * std::abs(sample.d1[j]) * root,
                        3 * std::abs(accel));
    const double sign = accel < 0 ? -1 : 1, filter = 3 * rate.slope / rate.share;
    jerk = full / rate.share - filter * std::abs(accel);
    per_slope = -filter * sign * 0.5 * sample.d1[j] / root;
    filter_per_b = -filter * sign * sample.d2[j] / root;
  }
  fixed *= jerk;
  if (!std::isnan(slope)) fixed -= drawn.limits.curvature / rate.share * std::abs(sample.d1[j]);
  const double per_b = -jerk / (2 * bar * root) + filter_per_b;
  return {fixed - per_b * bar - (std::isnan(slope) ? 0 : per_slope * slope), per_b, per_slope};
}

/// Every row there could be, by (8.5) and (8.6): |value| + rest <= limit of each joint at each
/// place.
std::vector<JerkRow> all_rows(const Drawn& drawn) {
  const JerkCell& at = drawn.at;
  std::vector<JerkRow> out;
  const auto add = [&out](double sign, const JerkCoefficients& value, const JerkCoefficients& rest,
                          double limit) {
    JerkRow row;
    for (std::size_t t = 0; t < 3; ++t) row.a[t] = sign * value[t] + rest[t];
    row.limit = limit;
    out.push_back(row);
  };
  const double h = drawn.cell.h;
  for (int j = 0; j < kJoints; ++j) {
    const CellSample& begin = drawn.cell.at[0];
    JerkCoefficients value{}, rest{};
    const double root = std::sqrt(at.bar[0]), d1 = std::abs(begin.d1[j]);
    const double accel = drawn.limits.acceleration[j] * at.accel_share;
    const auto rate = RateRoom::of_acceleration(drawn.limits.slope, drawn.limits.curvature)
                          .tangent(accel, d1 * root);
    const double filter = rate.slope / rate.share * d1;
    for (std::size_t t = 0; t < 3; ++t) {
      value[t] = 0.5 * begin.d1[j] * at.slope[t] + begin.d2[j] * at.b[t];
      rest[t] = filter / (2 * root) * at.b[t];  // the tangent of √b
    }
    const double limit = accel / rate.share - 0.5 * filter * root;
    if (!at.is_first) add(1, value, rest, limit), add(-1, value, rest, limit);
    for (std::size_t p = 0; p < 3; ++p) {
      const CellSample& sample = drawn.cell.at[p * 4];
      const double x = 0.5 * h * static_cast<double>(p);
      const JerkTangent tangent = tangent_of(drawn, j, p);
      for (std::size_t t = 0; t < 3; ++t) {
        const double bend = (at.end[t] - at.slope[t]) / h;
        const double slope = at.slope[t] + bend * x;
        const double b = at.b[t] + at.slope[t] * x + 0.5 * bend * x * x;
        value[t] = sample.d3[j] * b + 1.5 * sample.d2[j] * slope + 0.5 * sample.d1[j] * bend;
        rest[t] = -tangent.per_b * b - tangent.per_slope * slope;
      }
      add(1, value, rest, tangent.fixed);
      add(-1, value, rest, tangent.fixed);
    }
  }
  if (!at.is_first) out.push_back({at.b, at.max_b[0]});
  out.push_back({at.middle, at.max_b[1]});
  return out;
}

bool is_among(const JerkRow& row, const std::vector<JerkRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [&row](const JerkRow& other) {
    const double size = std::abs(other.limit) * 1e-12 + 1e-12;
    for (std::size_t t = 0; t < 3; ++t) {
      if (std::abs(row.a[t] - other.a[t]) > 1e-12 * (1 + std::abs(other.a[t]))) return false;
    }
    return std::abs(row.limit - other.limit) < size;
  });
}

TEST(JerkRows, AreThoseOfAccelerationJerkAndFeed) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Drawn drawn = draw(seed);
    drawn.at.cell = &drawn.cell;
    drawn.at.is_first = seed % 3 == 0;
    const std::vector<JerkRow> all = all_rows(drawn);
    JerkRows rows;
    rows.find(drawn.limits, drawn.at);
    for (int n = 0; n < rows.count(); ++n) {
      EXPECT_TRUE(is_among(rows[n], all)) << "seed " << seed << " row " << n;
    }
  }
}

/// Those left out can never be reached with b and |b'| inside their bounds and |b''| inside one row
/// of jerk: whatever keeps the rows that were found keeps all of them.
TEST(JerkRows, ImplyThoseThatAreLeftOut) {
  std::mt19937 random(1);
  int kept = 0, left_out = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Drawn drawn = draw(seed);
    drawn.at.cell = &drawn.cell;
    drawn.at.is_first = seed % 3 == 0;
    if (!drawn.at.is_first) bound_slope(drawn.limits, drawn.at);
    const std::vector<JerkRow> all = all_rows(drawn);
    JerkRows rows;
    rows.find(drawn.limits, drawn.at);
    left_out += static_cast<int>(all.size()) - rows.count();
    for (int n = 0; n < 2000; ++n) {
      JerkCoefficients c;
      const double middle = std::uniform_real_distribution<double>(5, 90)(random);
      const double width = std::uniform_real_distribution<double>(0, 40)(random);
      for (double& value : c) {
        value = middle + std::uniform_real_distribution<double>(-width, width)(random);
      }
      bool is_kept = c[0] > 0 && c[1] > 0 && c[2] > 0;
      const double b = product(drawn.at.b, c), end = 0.5 * (c[1] + c[2]);
      is_kept = is_kept && b <= drawn.at.max_b[0] && end <= drawn.at.max_b[2] &&
                std::abs(product(drawn.at.slope, c)) <= drawn.at.max_slope &&
                std::abs(product(drawn.at.end, c)) <= drawn.at.max_end;
      for (int r = 0; r < rows.count() && is_kept; ++r) {
        is_kept = product(rows[r].a, c) <= rows[r].limit;
      }
      if (!is_kept) continue;
      ++kept;
      for (const JerkRow& row : all) {
        EXPECT_LE(product(row.a, c), row.limit * (1 + 1e-9) + 1e-9) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(left_out, 350) << "hardly a row is left out: the programme is dear";
}

TEST(JerkRows, BoundTheSlopeByTheJointThatAllowsLeast) {
  Drawn drawn = draw(1);
  drawn.at.cell = &drawn.cell;
  drawn.at.accel_share = 0.5;
  drawn.at.bar[0] = 16;
  drawn.at.max_b[0] = 10;
  drawn.limits.slope = 0.5;
  drawn.limits.curvature = 0;
  drawn.limits.acceleration = {100, 40, 30};
  drawn.cell.at[0].d1 = {1, -0.5, 0};
  drawn.cell.at[0].d2 = {0.2, 0.1, 4};
  bound_slope(drawn.limits, drawn.at);
  // First: 2 (50 - 1 + 2); second: 2 (20 - 0.5 + 1)/0.5; the third never moves.
  EXPECT_EQ(drawn.at.slope_joint, 1);
  EXPECT_DOUBLE_EQ(drawn.at.max_slope, 82);
  drawn.limits.acceleration[0] = 60;
  bound_slope(drawn.limits, drawn.at);
  EXPECT_EQ(drawn.at.slope_joint, 0);
  EXPECT_DOUBLE_EQ(drawn.at.max_slope, 62);
  drawn.limits.curvature = 10;  // less room for the rate, so more slope
  bound_slope(drawn.limits, drawn.at);
  EXPECT_GT(drawn.at.max_slope, 63.4);
  EXPECT_LT(drawn.at.max_slope, 64);
}

TEST(JerkRows, KeepThoseOfTheJointThatBoundsTheSlope) {
  Drawn drawn = draw(2);
  drawn.at.cell = &drawn.cell;
  drawn.at.is_first = false;
  // Bounds so low that no row of acceleration binds, and jerk that no joint has.
  drawn.at.max_b = {1, 1, 1};
  drawn.at.max_slope = drawn.at.max_end = 1e-3;
  JerkRows rows;
  rows.find(drawn.limits, drawn.at);
  const int without = rows.count();
  drawn.at.slope_joint = 1;
  rows.find(drawn.limits, drawn.at);
  EXPECT_EQ(rows.count(), without + 2);
}

}  // namespace
}  // namespace meridian::test::jerk_rows
