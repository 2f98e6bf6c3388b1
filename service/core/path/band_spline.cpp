// SPDX-License-Identifier: Apache-2.0
#include "meridian/path/band_spline.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "service/core/path/band_hull.hpp"
#include "service/core/path/band_knots.hpp"
#include "service/core/path/band_polyline.hpp"
#include "service/core/path/band_smoother.hpp"
#include "service/core/path/speed_reach.hpp"

namespace meridian {
namespace {

/// A window looks at that many knots after its last control point.
constexpr std::int64_t kKnotsAhead = 7;
/// Vertices that a window may lie over, unless it would have fewer points than kMinWindow: what
/// the ring holds less what the knots look ahead and back.
constexpr std::int64_t kWindowVertices = kVertexCapacity - 4 * kVertexReach;
constexpr std::int64_t kMinWindow = 8;
/// A span is cut where a block in inverse time is so many times as slow as the one beside it, into
/// no less than that share of it.
constexpr double kSpeedJump = 4, kMinPart = 0.02;

std::size_t capacity_for(const BandTuning& tuning) noexcept {
  return std::bit_ceil(2 * static_cast<std::size_t>(tuning.window) + 64);
}

}  // namespace

struct BandSpline::Workspace {
  explicit Workspace(const BandTuning& numbers)
      : tuning(numbers),
        knots(capacity_for(numbers)),
        points(capacity_for(numbers)),
        smoother(numbers) {}

  void begin(const ToolPose& pose, const BandTolerance& tolerance) noexcept {
    line.begin(pose, tolerance);
    gaps.begin();
    knots.begin();
    points.clear();
    speeds.begin();
    first = 1;
    checked = 4;
    next_span = committed = 4;
    point_segment = block_end = axis_mark = 0;
    emitted_u = 0;
    is_last = has_failed = false;
  }

  /// Number of control points; meaningful once all knots are set.
  [[nodiscard]] std::int64_t count() const noexcept { return knots.count() - 5; }

  /// Cuts blocks in work and finds gaps as far as there is room.
  void advance_line() noexcept {
    for (std::int64_t before = -1; before != line.last();) {
      before = line.last();
      line.drop_before(
          std::min(gaps.needed_from(), knots.segment(std::max<std::int64_t>(first, 4))));
      line.cut();
      gaps.advance(line);
    }
  }

  /// Vertices between the begin of the window and knot `k`, nearly.
  [[nodiscard]] std::int64_t vertices_to(std::int64_t k) const noexcept {
    return knots.segment(k) - knots.segment(first);
  }

  /// Sets the knots that the next window needs. False where blocks are missing.
  bool advance_knots() noexcept {
    const auto needs_more = [&] {
      const std::int64_t last = knots.count() - 1;
      if (last < first + kMinWindow + kKnotsAhead) return true;
      return last < first + tuning.window + kKnotsAhead && vertices_to(last) <= kWindowVertices;
    };
    while (!knots.is_complete() && needs_more()) {
      if (!knots.advance(line, gaps)) return false;
    }
    return true;
  }

  /// Puts the control points of new knots on the polyline.
  void add_points() noexcept {
    const std::int64_t end = knots.is_complete() ? count() : knots.count() - 4;
    for (std::int64_t i = points.end_index(); i < end; ++i) {
      const double u = knots.greville(i);
      point_segment = line.segment_at(u, std::max(point_segment, line.first()));
      points.push(line.at(u, point_segment));
    }
  }

  /// The end of the window's free points, and whether it is the last window.
  std::int64_t find_window_end() noexcept {
    std::int64_t end = first + tuning.window;
    if (knots.is_complete()) end = std::min(end, count() - 1);
    const auto knot_behind = [&] { return std::min(end + kKnotsAhead, knots.count() - 1); };
    while (end > first + kMinWindow &&
           (vertices_to(knot_behind()) > kWindowVertices ||
            (!knots.is_complete() && end + kKnotsAhead >= knots.count()))) {
      --end;
    }
    is_last = knots.is_complete() && end == count() - 1;
    return end;
  }

  /// Bounds the mean spline where the window meets it for the first time.
  void check_mean(std::int64_t to) noexcept {
    for (; checked < to; ++checked) {
      const double deviation =
          bound_by_hull(line, quartic_of(knots, points, checked), knots.t(checked),
                        knots.t(checked + 1), knots.segment(checked));
      statistics.largest_mean = std::max(statistics.largest_mean, deviation);
    }
  }

  /// Smooths and commits one window. False where blocks are missing.
  bool run_window() noexcept {
    knots.drop_before(first - 8);
    points.drop_before(first - 8);
    advance_line();
    if (!advance_knots()) return false;
    add_points();
    const std::int64_t end = find_window_end();
    const std::int64_t limit = knots.is_complete() ? count() : points.end_index();
    if (tuning.bounds_mean) check_mean(std::min(end + 4, limit));
    const SmoothedWindow window = smoother.smooth(line, knots, points, first, end, limit);
    ++statistics.windows;
    statistics.pulled_windows += window.is_pulled ? 1 : 0;
    statistics.reset_windows += window.is_reset ? 1 : 0;
    statistics.largest = std::max(statistics.largest, window.largest);
    if (!window.is_inside) {
      has_failed = true;
      return false;
    }
    const std::int64_t before = first;
    const bool is_whole = end == first + tuning.window;
    first = is_last ? count() : first + (is_whole ? tuning.commit : (end - first) / 2);
    checked = std::max(checked, end + 4);
    committed = first;
    statistics.control_points += static_cast<std::uint64_t>(first - before);
    return true;
  }

  void emit() noexcept {
    const std::int64_t s = next_span;
    const double whole = knots.t(s + 1) - knots.t(s);
    std::int64_t i = line.segment_at(emitted_u, knots.segment(s)) + 1;
    const double end = find_cut(i, knots.t(s + 1), kMinPart * whole);
    span = {};
    span.u0 = knots.t(s);
    span.length = whole;
    span.c = quartic_of(knots, points, s);
    if (end - emitted_u < whole) {
      span = part_of_span(span, emitted_u - span.u0, end - emitted_u);
      span.u0 = emitted_u;
    }
    emitted_u = end;
    if (end == knots.t(s + 1)) ++next_span;
    block_end = std::max(block_end, i);
    span.sequence = line[i].sequence;
    span.line = line[i].line;
    for (;; ++i) {
      span.feed_mm_per_s = std::min(span.feed_mm_per_s, line[i].feed_mm_per_s);
      span.u_speed_mm_per_s = std::min(span.u_speed_mm_per_s, line[i].u_speed_mm_per_s);
      if (i >= line.last() || line[i].u >= end) break;
    }
    speeds.go_to(line, span.u0, end, i);
    if (std::isfinite(span.u_speed_mm_per_s)) {
      span.feed_mm_per_s = std::min(span.feed_mm_per_s, speeds.tip_mm_per_s());
      span.turn_rad_per_s = speeds.turn_rad_per_s();
      share_short_times(i);
    }
  }

  /// Where the span from `emitted_u`, on the segment that ends in vertex `i`, has to end: `to`, or
  /// ahead of it where a slow block in inverse time begins or ends: the one beside it would be as
  /// slow. Short blocks have their times together.
  [[nodiscard]] double find_cut(std::int64_t i, double to, double min_part) const noexcept {
    for (; i < line.last() && line[i].u + min_part < to; ++i) {
      const BandVertex &a = line[i], &b = line[i + 1];
      if (a.is_short_in_time && b.is_short_in_time) continue;
      const auto [slow, fast] = std::minmax(a.u_speed_mm_per_s, b.u_speed_mm_per_s);
      const bool is_jump = std::isfinite(slow) && fast > kSpeedJump * slow;
      if (is_jump && line[i].u > emitted_u + min_part) return line[i].u;
    }
    return to;
  }

  /// Of blocks in inverse time that are shorter than the tolerances, up to the segment that ends in
  /// `end`, the span takes the times together. At the speed of the slowest all of the span would
  /// take many times that of a block that is a small part of it.
  void share_short_times(std::int64_t end) noexcept {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const double u1 = span.u0 + span.length;
    double slowest = kInfinite, time_s = 0;
    bool has_short = false;
    for (std::int64_t i = end; i > line.first() && line[i].u > span.u0; --i) {
      const BandVertex& vertex = line[i];
      const double part = std::min(vertex.u, u1) - std::max(line[i - 1].u, span.u0);
      time_s += std::max(part, 0.0) / vertex.u_speed_mm_per_s;
      has_short = has_short || vertex.is_short_in_time;
      if (!vertex.is_short_in_time) slowest = std::min(slowest, vertex.u_speed_mm_per_s);
    }
    if (has_short) span.u_speed_mm_per_s = std::min(slowest, span.length / time_s);
  }

  BandTuning tuning;
  BandPolyline line;
  BandGaps gaps;
  BandKnots knots;
  ControlPoints points;
  BandSmoother smoother;
  SpeedReach speeds;
  BandStatistics statistics;
  BandSpan span;
  std::int64_t first = 1;      ///< first control point that is not final
  std::int64_t checked = 4;    ///< spans before this one are bounded
  std::int64_t next_span = 4;  ///< to be handed out, from `emitted_u` on
  std::int64_t committed = 4;  ///< spans before this one are final
  std::int64_t point_segment = 0, block_end = 0, axis_mark = 0;
  double emitted_u = 0;
  bool is_last = false;  ///< the last window is done
  bool has_failed = false;
};

BandSpline::BandSpline(const BandTuning& tuning)
    : workspace_(std::make_unique<Workspace>(tuning)) {}
BandSpline::~BandSpline() = default;

void BandSpline::begin(const ToolPose& pose, const BandTolerance& tolerance) noexcept {
  workspace_->begin(pose, tolerance);
}

bool BandSpline::push(const ClBlock& block) noexcept {
  if (!workspace_->line.cut()) return false;
  workspace_->line.take(block);
  return true;
}

void BandSpline::finish() noexcept { workspace_->line.finish(); }

const BandSpan* BandSpline::next() noexcept {
  Workspace& w = *workspace_;
  while (w.next_span >= w.committed) {
    if (w.is_last || w.has_failed || !w.run_window()) return nullptr;
  }
  w.emit();
  return &w.span;
}

std::optional<BlockEnd> BandSpline::next_block_end() noexcept {
  Workspace& w = *workspace_;
  const double end = w.emitted_u;
  for (; w.block_end <= w.line.last() && w.line[w.block_end].u <= end; ++w.block_end) {
    const BandVertex& vertex = w.line[w.block_end];
    if (!vertex.ends_block) continue;
    ++w.block_end;
    return BlockEnd{vertex.u, vertex.sequence, vertex.line, vertex.block_feed_mm_per_s};
  }
  return std::nullopt;
}

std::optional<BlockEnd> BandSpline::block_behind() const noexcept {
  const Workspace& w = *workspace_;
  if (w.block_end > w.line.last()) return std::nullopt;
  const BandVertex& vertex = w.line[w.block_end];
  return BlockEnd{vertex.u, vertex.sequence, vertex.line, vertex.block_feed_mm_per_s};
}

std::optional<AxisMark> BandSpline::next_axis() noexcept {
  Workspace& w = *workspace_;
  w.axis_mark = std::max(w.axis_mark, w.line.first());
  if (w.axis_mark > w.line.last()) return std::nullopt;
  const BandVertex& vertex = w.line[w.axis_mark++];
  return AxisMark{
      vertex.u, {vertex.x[0], vertex.x[1], vertex.x[2]}, {vertex.x[3], vertex.x[4], vertex.x[5]}};
}

bool BandSpline::is_done() const noexcept {
  const Workspace& w = *workspace_;
  const bool has_no_length = w.line.is_complete() && w.line.last() < 1;
  return has_no_length || (w.is_last && w.next_span >= w.committed);
}

bool BandSpline::has_failed() const noexcept { return workspace_->has_failed; }

const BandStatistics& BandSpline::statistics() const noexcept { return workspace_->statistics; }

}  // namespace meridian
