// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/band_span.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "property/planner/plan_trace.hpp"
#include "property/planner/random_programs.hpp"
#include "service/core/planner/feed/rolling/rolling_feed.hpp"

/// Smooth paths for the feed planner and what it makes of them, checked by setpoints alone.
namespace meridian::test {

/// A path whose spans are there, and the joints at its begin.
struct FeedPath {
  MachineModel model;
  std::vector<BandSpan> spans;
  JointVector start{};
  int branch = 0;
};

/// Quartic B-spline with equal knot gaps whose control points lie on the polyline through `poses`.
inline std::vector<BandSpan> make_spans(const std::vector<ToolPose>& poses, double gap,
                                        double feed_mm_per_s) {
  std::vector<double> u{0};
  for (std::size_t n = 1; n < poses.size(); ++n) {
    u.push_back(u.back() + std::hypot((poses[n].tip - poses[n - 1].tip).norm(),
                                      50 * (poses[n].axis - poses[n - 1].axis).norm()));
  }
  const auto at = [&](double x) {
    const auto upper = std::upper_bound(u.begin() + 1, u.end() - 1, x);
    const auto n = static_cast<std::size_t>(upper - u.begin());
    const double length = u[n] - u[n - 1];
    const double share = length > 0 ? std::clamp((x - u[n - 1]) / length, 0.0, 1.0) : 0.0;
    std::array<double, 6> out;
    for (int i = 0; i < 3; ++i) {
      out[i] = poses[n - 1].tip[i] + share * (poses[n].tip[i] - poses[n - 1].tip[i]);
      out[i + 3] = poses[n - 1].axis[i] + share * (poses[n].axis[i] - poses[n - 1].axis[i]);
    }
    return out;
  };
  const int count = std::max(1, static_cast<int>(u.back() / gap));
  const double h = u.back() / count;
  const auto knot = [&](int k) { return h * std::clamp(k - 4, 0, count); };  // clamped ends
  std::vector<BandSpan> spans;
  for (int s = 0; s < count; ++s) {
    // Derivatives at the begin of the span by de Boor's recursion on its five control points.
    std::vector<std::array<double, 6>> points(5);
    for (int j = 0; j < 5; ++j) {
      double sum = 0;
      for (int k = 1; k <= 4; ++k) sum += knot(s + j + k);
      points[j] = at(sum / 4);
    }
    BandSpan span;
    span.u0 = h * s;
    span.length = h;
    span.feed_mm_per_s = feed_mm_per_s;
    span.sequence = static_cast<std::uint64_t>(s);
    const double x = knot(s + 4);
    double factorial = 1;
    for (int order = 0; order <= 4; ++order) {
      const int degree = 4 - order;
      auto level = points;
      for (int r = 1; r <= degree; ++r) {
        for (int j = degree; j >= r; --j) {
          const double a = knot(s + order + j), b = knot(s + 5 + j - r);
          const double w = (x - a) / (b - a);
          for (int d = 0; d < 6; ++d) level[j][d] = (1 - w) * level[j - 1][d] + w * level[j][d];
        }
      }
      factorial *= std::max(order, 1);
      for (int d = 0; d < 6; ++d) span.c[d][order] = level[degree][d] / factorial;
      for (int j = 0; j < degree; ++j) {
        const double width = knot(s + 5 + j) - knot(s + order + 1 + j);
        for (int d = 0; d < 6; ++d) {
          points[j][d] = degree / width * (points[j + 1][d] - points[j][d]);
        }
      }
    }
    spans.push_back(span);
  }
  return spans;
}

/// A path that wanders in the machine's joints: curves, corners, reversals, pure rotations, noise,
/// at gaps and feeds of all sizes. `margin` keeps it off the pole and the ends of travel.
inline FeedPath draw_path(const MachineModel& model, RandomPrograms& draw) {
  FeedPath path;
  path.model = model;
  JointVector middle{};
  for (int i = 0; i < model.joint_count; ++i) {
    const JointLimits& limits = model.joints[i].limits;
    middle[i] = model.joints[i].is_endless ? 0 : 0.5 * (limits.travel_min + limits.travel_max);
    const double off = model.joints[i].is_rotary ? 0.6 : 20;
    middle[i] += draw.chance(0.5) ? off : -off;
  }
  const int kind = static_cast<int>(draw.uniform(0, 5));
  const double step_mm = draw.log_uniform(0.05, 15), step_rad = draw.log_uniform(0.0005, 0.04);
  const int count = static_cast<int>(draw.uniform(5, 60));
  std::vector<ToolPose> poses;
  JointVector q = middle, phase{}, rate{};
  for (int i = 0; i < kMaxJoints; ++i) {
    phase[i] = draw.uniform(0, 6.28);
    rate[i] = draw.uniform(0.05, 0.5);
  }
  for (int n = 0; n < count; ++n) {
    poses.push_back(forward(model, model.tool_length_mm, q));
    const bool moves = kind != 3 || n % 3 != 0;  // 3: pure rotations between
    for (int i = 0; i < model.joint_count; ++i) {
      const double size = model.joints[i].is_rotary ? step_rad : (moves ? step_mm : 0.0);
      double by = size * std::sin(phase[i] + rate[i] * n);                      // 0: curve
      if (kind == 1) by = size * draw.uniform(-1, 1);                           // corners
      if (kind == 2) by = (n % 7 < 4 ? size : -size) * (i % 2 == 0 ? 1 : 0.3);  // reversals
      if (kind == 4) by += 0.02 * size * draw.uniform(-1, 1);                   // noise
      const double far = model.joints[i].is_rotary ? 0.3 : 15 * step_mm;
      q[i] = middle[i] + std::clamp(q[i] + by - middle[i], -far, far);
    }
  }
  const double length = [&] {
    double sum = 0;
    for (std::size_t n = 1; n < poses.size(); ++n) {
      sum += std::hypot((poses[n].tip - poses[n - 1].tip).norm(),
                        50 * (poses[n].axis - poses[n - 1].axis).norm());
    }
    return sum;
  }();
  const double gap = std::max(draw.log_uniform(0.05, 3), length / 400);
  path.spans = make_spans(poses, gap, draw.log_uniform(8, 900));
  // Branch and joints of the begin.
  double nearest = 1e300;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    const auto at =
        solve(model, model.tool_length_mm, pose_on(path.spans[0].c, 0.0), branch, middle);
    double distance = 0;
    for (int i = 0; i < model.joint_count; ++i) distance += std::abs(at.q[i] - middle[i]);
    if (at.status != SolveStatus::kOk || !(distance < nearest)) continue;
    nearest = distance;
    path.branch = branch;
    path.start = at.q;
  }
  return path;
}

/// What was planned of a path, in the order in which the machine runs it.
struct FeedRun {
  std::vector<FeedPiece> pieces;
  FeedCount count;
  PathFault fault;
  bool ended_at_rest = true;  ///< every window, its tail included
  [[nodiscard]] double duration_s() const {
    double sum = 0;
    for (const FeedPiece& piece : pieces) sum += piece.duration;
    return sum;
  }
};

[[nodiscard]] inline PathState end_of(const FeedPiece& piece) {
  TimePiece law;
  law.s0 = piece.s0;
  law.v = piece.v;
  law.a = piece.a;
  law.j = piece.j;
  law.k = piece.k;
  return state_at(law, piece.duration);
}

/// Runs a path through the planner. `is_starved(n)`: whether the machine ran the tail of window n.
/// `eager`: windows are asked for after every span, else only when no more spans fit.
template <class Starved>
inline FeedRun run_feed(const FeedPath& path, const FeedSettings& settings, bool eager,
                        const Starved& is_starved) {
  FeedRun run;
  RollingFeed feed(path.model, settings);
  feed.begin(path.start, path.branch, path.model.tool_length_mm);
  int window = 0;
  const auto take_windows = [&] {
    while (feed.try_plan()) {
      const FeedWindow& w = feed.window();
      const auto& last = w.tail.empty() ? w.committed.back() : w.tail.back();
      EXPECT_LT(w.tail.size(), MotionReader::kMaxDrops);  // skipped in one call of the cycle
      const PathState end = end_of(last);
      if (std::abs(end.ds) > 1e-9 * (1 + last.v)) run.ended_at_rest = false;
      run.pieces.insert(run.pieces.end(), w.committed.begin(), w.committed.end());
      if (!w.tail.empty() && is_starved(window)) {
        run.pieces.insert(run.pieces.end(), w.tail.begin(), w.tail.end());
        feed.resume_from(w.rest_cell);
      }
      ++window;
    }
  };
  for (const BandSpan& span : path.spans) {
    if (eager || !feed.has_room()) take_windows();
    run.fault = feed.push(span);
    if (run.fault.kind != PathFault::Kind::kNone) break;
  }
  if (run.fault.kind == PathFault::Kind::kNone) run.fault = feed.finish();
  take_windows();
  run.count = feed.count();
  if (!feed.is_done()) run.ended_at_rest = false;
  return run;
}

/// Setpoints at plan times `time(0)`, `time(1)`, ... up to the end, four at rest either side.
struct FeedSetpoints {
  std::vector<PlanSample> joints;
  std::vector<Vector3> tip;
  std::vector<double> feed;  ///< programmed, of the span
};

template <class Time>
inline FeedSetpoints sample_feed(const FeedPath& path, const FeedRun& run, const Time& time) {
  FeedSetpoints out;
  JointVector reference = path.start;
  std::size_t n = 0;
  double begin = 0;
  int left = 4;
  for (int k = -4; left > 0; ++k) {
    const double t = std::max(0.0, k < 0 ? 0.0 : time(k));
    while (n + 1 < run.pieces.size() && t - begin >= run.pieces[n].duration) {
      begin += run.pieces[n++].duration;
    }
    const FeedPiece& piece = run.pieces[n];
    if (t - begin >= piece.duration) --left;
    FeedPiece part = piece;
    part.duration = std::min(t - begin, piece.duration);
    const BandSpan& span = path.spans[piece.span];
    const double x = end_of(part).s;
    const ToolPose pose = pose_on(span.c, x);
    reference = solve(path.model, path.model.tool_length_mm, pose, path.branch, reference).q;
    out.joints.push_back({reference, static_cast<int>(n), x});
    out.tip.push_back(pose.tip);
    out.feed.push_back(span.feed_mm_per_s);
  }
  return out;
}

/// Largest use of velocity, acceleration, jerk and feed.
struct FeedPeaks {
  double v = 0, a = 0, j = 0, feed = 0;
  std::string where;
  [[nodiscard]] double worst() const { return std::max({v, a, j, feed}); }
  void take(const FeedPeaks& other) {
    v = std::max(v, other.v);
    a = std::max(a, other.a);
    j = std::max(j, other.j);
    feed = std::max(feed, other.feed);
  }
};

inline FeedPeaks check(const FeedPath& path, const FeedSetpoints& setpoints, double cycle_s) {
  const LimitUse use = measure_limits(path.model, setpoints.joints, cycle_s);
  FeedPeaks peaks{use.v, use.a, use.j, 0, use.where};
  for (std::size_t n = 1; n < setpoints.tip.size(); ++n) {
    const double moved = (setpoints.tip[n] - setpoints.tip[n - 1]).norm() - 1e-12;
    peaks.feed = std::max(peaks.feed, moved / cycle_s / setpoints.feed[n]);
  }
  return peaks;
}

}  // namespace meridian::test
