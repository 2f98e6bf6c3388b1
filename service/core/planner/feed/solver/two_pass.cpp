// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/two_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace meridian {
namespace {

constexpr double kNone = 1e-12;  // coefficient that counts as none
constexpr int kMaxRounds = 24;   // of a search that ends after four

/// p b₁ + r b₀ <= limit
struct Row {
  double p = 0, r = 0, limit = 0;
};

class Rows {
 public:
  Rows(const FeedCell& cell, const FeedLimits& limits) noexcept {
    const double per_length = 0.5 / cell.h;
    const CellSample &left = cell.at.front(), &right = cell.at.back();
    for (int i = 0; i < limits.count; ++i) {
      const double l = left.d1[i] * per_length, r = right.d1[i] * per_length;
      add(l, left.d2[i] - l, limits.acceleration[i]);
      add(r + right.d2[i], -r, limits.acceleration[i]);
    }
  }
  [[nodiscard]] const Row* begin() const noexcept { return row_.data(); }
  [[nodiscard]] const Row* end() const noexcept { return row_.data() + count_; }

 private:
  void add(double p, double r, double limit) noexcept {
    row_[static_cast<std::size_t>(count_++)] = {p, r, limit};
    row_[static_cast<std::size_t>(count_++)] = {-p, -r, limit};
  }

  std::array<Row, 4 * kMaxLimited> row_;
  int count_ = 0;
};

/// A bound of b₁ as a function of b₀.
struct Line {
  double slope = 0, offset = 0;
  [[nodiscard]] double at(double b0) const noexcept { return slope * b0 + offset; }
};

/// Largest b₀ <= `largest` for which a b₁ in [0, `after`] keeps every row.
double largest_begin(const Rows& rows, double largest, double after) noexcept {
  double b0 = largest;
  for (const Row& row : rows) {
    if (std::abs(row.p) <= kNone && row.r > kNone) b0 = std::min(b0, row.limit / row.r);
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    Line high{0, after}, low{0, 0};
    for (const Row& row : rows) {
      if (std::abs(row.p) <= kNone) continue;
      const Line line{-row.r / row.p, row.limit / row.p};
      if (row.p > 0) {
        if (line.at(b0) < high.at(b0)) high = line;
      } else if (line.at(b0) > low.at(b0)) {
        low = line;
      }
    }
    if (high.at(b0) >= low.at(b0) - 1e-9 * (1 + std::abs(high.at(b0)))) break;
    const double next = (high.offset - low.offset) / (low.slope - high.slope);
    if (!(next < b0)) break;
    b0 = next;
  }
  return std::max(b0, 0.0);
}

}  // namespace

void two_pass(const CellGrid& grid, const FeedLimits& limits, std::int64_t first, double b_begin,
              std::span<double> backward, std::span<double> b) noexcept {
  const std::size_t n = b.size() - 1;
  backward[n] = 0;
  for (std::size_t k = n; k-- > 0;) {
    const std::int64_t cell = first + static_cast<std::int64_t>(k);
    backward[k] = largest_begin(Rows(grid[cell], limits), grid.max_b_at(cell), backward[k + 1]);
  }
  b[0] = std::min(b_begin, backward[0]);
  for (std::size_t k = 0; k < n; ++k) {
    const Rows rows(grid[first + static_cast<std::int64_t>(k)], limits);
    double y = backward[k + 1];
    for (const Row& row : rows) {
      if (row.p > kNone) y = std::min(y, (row.limit - row.r * b[k]) / row.p);
    }
    b[k + 1] = std::max(y, 0.0);
  }
}

}  // namespace meridian
