// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/feed_piece.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/time_law.hpp"

namespace meridian {
namespace {

/// Time in which the law covers `length`, by Newton from `guess`.
double time_over(const FeedPiece& piece, double length, double guess) noexcept {
  TimePiece law;
  law.v = piece.v;
  law.a = piece.a;
  law.j = piece.j;
  law.k = piece.k;
  double t = guess;
  for (int n = 0; n < 30; ++n) {
    const PathState at = state_at(law, t);
    const double step = (length - at.s) / at.ds;
    t = std::clamp(t + step, 0.25 * t, 4 * t);
    if (std::abs(step) <= 2e-16 * t) break;
  }
  return t;
}

/// ∫ dx/√b by Simpson's rule.
double estimate_time(const CellLaw& law, double second, double x, double length) noexcept {
  constexpr int kIntervals = 8;
  double sum = 0;
  for (int k = 0; k <= kIntervals; ++k) {
    const double at = x + length * k / kIntervals;
    const double b = law.b + at * (law.slope + 0.5 * second * at);
    const double weight = k == 0 || k == kIntervals ? 1 : (k % 2 == 1 ? 4 : 2);
    sum += weight / std::sqrt(std::max(b, 1e-300));
  }
  return sum * length / (3 * kIntervals);
}

}  // namespace

void FeedPieces::add(const FeedCell& cell, std::int64_t number, const CellLaw& law) noexcept {
  const double second = (law.slope_end - law.slope) / cell.h;
  const double time = estimate_time(law, second, 0, cell.h);
  int parts = 1;
  while (parts < kMaxParts && 0.5 * std::abs(second) * time * time > 0.9 * parts * parts) {
    parts *= 2;
  }
  for (int n = 0; n < parts; ++n) {
    const double x = cell.h * n / parts, end = cell.h * (n + 1) / parts;
    const double b = law.b + x * (law.slope + 0.5 * second * x);
    FeedPiece piece{cell.span,  number,       0,
                    cell.x + x, std::sqrt(b), 0.5 * (law.slope + second * x),
                    0,          0.5 * second};
    piece.duration = time_over(piece, end - x, estimate_time(law, second, x, end - x));
    add(piece);
  }
}

void FeedPieces::add(const FeedCell& cell, std::int64_t number, const RestCell& rest,
                     bool is_start) noexcept {
  FeedPiece piece{cell.span, number, rest.duration, cell.x, 0, 0, rest.jerk, 0};
  if (!is_start) {
    piece.v = 0.5 * rest.jerk * rest.duration * rest.duration;
    piece.a = -rest.jerk * rest.duration;
  }
  add(piece);
}

void FeedPieces::add(const CellGrid& grid, std::int64_t first, const Crawl& crawl) noexcept {
  const double t = crawl.duration, d = crawl.length;
  double begin = 0;
  for (int n = 0; n < crawl.cells; ++n) {
    const FeedCell& cell = grid[first + n];
    const double end = n + 1 == crawl.cells ? d : begin + cell.h;
    // Ends of phases inside the cell.
    double cut[5] = {begin};
    int cuts = 1;
    for (const double share : {1.0 / 12, 0.5, 11.0 / 12}) {
      if (d * share > begin && d * share < end) cut[cuts++] = d * share;
    }
    cut[cuts] = end;
    for (int k = 0; k < cuts; ++k) {
      const Crawl::Shape from = Crawl::shape_at(cut[k] / d);
      const Crawl::Shape middle = Crawl::shape_at(0.5 * (cut[k] + cut[k + 1]) / d);
      const Crawl::Shape to = Crawl::shape_at(cut[k + 1] / d);
      add({cell.span, first + n, t * (to.t - from.t), cell.x + (cut[k] - begin), d * from.v / t,
           d * from.a / (t * t), d * middle.j / (t * t * t), 0});
    }
    begin = end;
  }
}

}  // namespace meridian
