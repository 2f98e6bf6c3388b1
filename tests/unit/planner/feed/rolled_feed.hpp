// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "service/core/planner/feed/rolling/rolling_feed.hpp"
#include "support/machines.hpp"

/// Paths for the rolling feed, and what it plans of them, window by window.
namespace meridian::test {

[[nodiscard]] inline FeedSettings without_reserve() {
  FeedSettings settings;
  settings.reserve = {0, 0};
  return settings;
}

/// The state at the end of a piece, and at a share of its duration.
[[nodiscard]] inline PathState state_on(const FeedPiece& piece, double share) {
  TimePiece law;
  put_law(piece, law);
  return state_at(law, share * piece.duration);
}

struct RolledWindow {
  bool is_from_rest = false;
  std::vector<FeedPiece> committed, tail;
  std::int64_t rest_cell = 0;
};

/// Spans of one path with cells of their own number, and the feed over them.
struct Rolled {
  explicit Rolled(const FeedSettings& settings = without_reserve(),
                  const MachineModel& m = bench_machine())
      : model(m), feed(model, settings) {}

  /// `count` spans of `length` mm and `cells` cells each, along joint 0.
  void add_straight(int count, double length, int cells, double u_speed = 1e9) {
    for (int n = 0; n < count; ++n) {
      JointVector end = at;
      end[0] += length;
      FeedSpan span;
      span.path = make_joint_move(at, end, 0);
      span.length = span.path.length;
      span.cells = cells;
      span.u_speed_mm_per_s = u_speed;
      spans.push_back(span);
      at = end;
    }
  }
  /// A line whose axis turns, cut into spans of ten cells; the path begins with it.
  void add_bent(int count, double tip_speed) {
    const ToolPose from{Vector3(0, 30, -20), Vector3(0.3, 0.2, 1).normalized()};
    const ToolPose to{Vector3(30, -10, 0), Vector3(-0.3, 0.25, 1).normalized()};
    FeedSpan span;
    span.path = make_line(from, to);
    span.path.tool_length_mm = model.tool_length_mm;
    span.length = span.path.length / count;
    span.cells = 10;
    span.feed_mm_per_s = tip_speed;
    for (int n = 0; n < count; ++n) {
      spans.push_back(span);
      span.begin += span.length;
    }
    start = solve(model, model.tool_length_mm, from, 0, JointVector{}).q;
  }

  void begin() { feed.begin(start, 0, model.tool_length_mm); }
  void take_windows() {
    while (feed.try_plan()) {
      const FeedWindow& w = feed.window();
      windows.push_back({w.is_from_rest,
                         {w.committed.begin(), w.committed.end()},
                         {w.tail.begin(), w.tail.end()},
                         w.rest_cell});
    }
  }
  /// All of the path; windows are asked for after every span, or when no more fit.
  void run(bool is_eager = true) {
    begin();
    for (const FeedSpan& span : spans) {
      if (is_eager || !feed.has_room()) take_windows();
      ASSERT_FALSE(is_fault(feed.push(span)));
    }
    ASSERT_FALSE(is_fault(feed.finish()));
    take_windows();
    EXPECT_TRUE(feed.is_done());
  }
  [[nodiscard]] std::vector<FeedPiece> pieces() const {
    std::vector<FeedPiece> out;
    for (const RolledWindow& w : windows) {
      out.insert(out.end(), w.committed.begin(), w.committed.end());
    }
    return out;
  }
  [[nodiscard]] double duration() const {
    double sum = 0;
    for (const FeedPiece& piece : pieces()) sum += piece.duration;
    return sum;
  }
  /// The largest use of the limits by `run`, at the ends of pieces and between.
  [[nodiscard]] FeedUse use(const std::vector<FeedPiece>& run) const {
    FeedUse out;
    JointVector reference = start;
    for (const FeedPiece& piece : run) {
      for (const double share : {0.0, 0.3, 0.7, 1.0}) {
        const PathState p = state_on(piece, share);
        CellSample sample;
        EXPECT_FALSE(is_fault(
            take_sample(model, feed.limits(), 1, spans[piece.span], p.s, reference, sample)));
        add_use(feed.limits(), sample, p.ds, p.dds, p.ddds, out);
      }
    }
    return out;
  }

  MachineModel model;
  RollingFeed feed;
  JointVector start{}, at{};
  std::vector<FeedSpan> spans;
  std::vector<RolledWindow> windows;
};

/// Straight on, and beside it a swing in two spans of 75 short cells, at whose end the swinging
/// joint rests in two derivatives by u but not in the third.
inline void add_swing(Rolled& one) {
  constexpr double kLength = 0.5, kBend = 3, kThird = 4 * kBend / kLength;
  constexpr double kRate = 2 * kBend * kLength / 3;  // of y in the middle; y'' = 4 bend t (1 - t)
  JointSpan span;
  const auto add = [&](double length, int cells) {
    span.band.length = length;
    FeedSpan out = make_feed_span(span, one.model.tool_length_mm);
    out.feed_mm_per_s = 50;
    out.cells = cells;
    one.spans.push_back(out);
    span.band.c[0][0] += length;
  };
  span.band.c = {
      {{30, 1}, {0, 0, 0, kThird / 6, -kThird / (12 * kLength)}, {-20}, {0.3}, {0.3}, {1}}};
  one.start = solve(one.model, one.model.tool_length_mm, pose_on(span.band.c, 0.0), 0, {}).q;
  add(kLength, 75);
  span.band.c[1] = {kRate * kLength / 2, kRate, 0, -kThird / 6, kThird / (12 * kLength)};
  add(kLength, 75);
  span.band.c[1] = {kRate * kLength};
  add(12, 54);
}

/// Expects pieces that follow one another, with speed and acceleration, from `v`, `a` to rest.
inline void expect_joined(const std::vector<FeedPiece>& run, double v = 0, double a = 0) {
  ASSERT_FALSE(run.empty());
  double s = run.front().s0;
  std::uint64_t span = run.front().span;
  for (const FeedPiece& piece : run) {
    if (piece.span == span) {
      EXPECT_NEAR(piece.s0, s, 1e-9);
    }
    EXPECT_NEAR(piece.v, v, 1e-9 * (1 + v));
    EXPECT_NEAR(piece.a, a, 1e-6 * (1 + std::abs(a)));
    EXPECT_GE(piece.duration, 0);
    const PathState end = state_on(piece, 1);
    span = piece.span;
    s = end.s;
    v = end.ds;
    a = end.dds;
  }
  EXPECT_NEAR(v, 0, 1e-9);
}

}  // namespace meridian::test
