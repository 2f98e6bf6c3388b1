// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/leg_feed.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/joints_at.hpp"

namespace meridian {
namespace {

constexpr double kCell_s = 0.004;  // at full speed, next to rest and as long as they are few
constexpr double kMinLegCells = CellGrid::kMin, kMaxFeedCells = 360;  // cells away from rest
constexpr double kCellGrowth = 1.25;                                  // of cells, away from rest
constexpr std::size_t kMaxGrowing = 64;                               // of them, next to a rest
constexpr std::size_t kEnds = 512;
constexpr int kKeptCells = 256;   // at a time: a window, and what stands before and behind it
constexpr int kCommitCells = 80;  // of a window: all cells are there, so fewer windows do
constexpr int kMaxRounds = 80;    // of the solver in a window: what needs more finds no plan

FeedSettings leg_settings(const MachineModel& model) noexcept {
  FeedSettings settings = feed_settings(model);
  settings.window_cells = JerkStep::kCells;
  settings.commit_cells = kCommitCells;
  settings.cells.kept_cells = kKeptCells;
  settings.max_rounds = kMaxRounds;
  return settings;
}

/// Into `finer`: the ends of cells `ends`, ascending, and between them those of cells that are no
/// longer than `first`, or a share of their distance to the rest at 0.
void grade_from_rest(std::span<const double> ends, double first,
                     std::vector<double>& finer) noexcept {
  finer.clear();
  double x = 0;
  for (std::size_t n = 0; n < ends.size(); ++n) {
    for (;;) {
      const double h = ends[n] - x, longest = std::max(first, CellGrid::kRestGrowth * x);
      if (!(h > longest) || finer.size() + (ends.size() - n) >= kEnds) break;
      finer.push_back(x += h / std::ceil(h / longest));
      if (!(x < ends[n])) break;
    }
    if (finer.empty() || finer.back() < ends[n]) finer.push_back(ends[n]);
    x = ends[n];
  }
}

/// Ends of cells that come from the other end of a path of `length`.
void turn_round(std::vector<double>& ends, double length) noexcept {
  std::reverse(ends.begin(), ends.end());
  for (std::size_t n = 0; n + 1 < ends.size(); ++n) ends[n] = length - ends[n + 1];
  ends.back() = length;
}

/// About the time of the fastest motion over `length` inside `limits` that leaves the rate filter
/// its room where acceleration and velocity are: while acceleration grows half of what its peak
/// asks for.
double duration_with_room(double length, const PathLimits& limits) noexcept {
  const Profile fastest = rest_to_rest(length, limits);
  PathLimits left =
      limits_beside_rate(limits, fastest.peak_velocity(), fastest.peak_acceleration());
  left.jerk = 0.5 * (limits.jerk + left.jerk);
  if (!(left.acceleration > 0) || !(left.jerk > 0)) return 0;
  return rest_to_rest(length, left).duration();
}

}  // namespace

LegFeed::LegFeed(const MachineModel& model)
    : model_(model), feed_(model, leg_settings(model)), stop_margin_(model) {
  ends_.reserve(kEnds + 1);
  finer_.reserve(kEnds + 1);
}

double LegFeed::plan(const Leg& leg, std::span<const JointCell> cells, double less_than_s,
                     Staging& out, JointVector& joints) noexcept {
  PathPiece piece = leg.path;
  piece.joints_begin = joints_at(model_, piece, 0.0, joints).q;
  set_cells(leg, cells);
  feed_.begin(joints, piece.branch, piece.tool_length_mm);
  const Staging::Mark mark = out.mark();
  piece.index = out.first_index + static_cast<std::uint64_t>(out.path_count);
  Times times{leg.time_on(piece), less_than_s, 0};
  if (!push_cells(leg, times, out) || !stage_windows(times, out) || !feed_.is_done()) {
    out.go_back(mark);
    return 0;
  }
  piece.joints_end = joints_at(model_, piece, piece.length, feed_.grid().joints()).q;
  if (!out.add(piece)) {
    out.go_back(mark);
    return 0;
  }
  joints = piece.joints_end;
  return times.duration;
}

double LegFeed::time_over(const Leg& leg, const JointCell& cell) const noexcept {
  const FeedLimits& limits = feed_.limits();
  double slowest = 1 / leg.max_velocity(cell.share_rate);
  for (int i = 0; i < limits.count; ++i) {
    slowest = std::max({slowest, cell.d1[i] / limits.velocity[i],
                        kCurvatureShare * std::sqrt(cell.d2[i] / limits.acceleration[i]),
                        kCurvatureShare * std::cbrt(cell.d3[i] / limits.jerk[i])});
  }
  return slowest * (cell.end - cell.begin);
}

void LegFeed::set_cells(const Leg& leg, std::span<const JointCell> cells) noexcept {
  double whole = 0;
  for (const JointCell& cell : cells) whole += time_over(leg, cell);
  const double step = std::clamp(kCell_s, whole / kMaxFeedCells, whole / kMinLegCells);
  // Ends by time: growing up to a step, over five steps at most, evenly, and shrinking again.
  ends_.clear();
  double ramp = 0;
  for (double by = kCell_s; by < step && ends_.size() < kMaxGrowing; by *= kCellGrowth) {
    ends_.push_back(ramp += by);
  }
  const std::size_t growing = ends_.size();
  const double even = whole - 2 * ramp;
  const auto steps = static_cast<int>(std::ceil(even / step));
  for (int n = 1; n <= steps; ++n) ends_.push_back(ramp + even * n / steps);
  for (std::size_t n = growing; n-- > 1;) ends_.push_back(whole - ends_[n - 1]);
  if (growing > 0) ends_.push_back(whole);
  // To path length, through the cells.
  double time = 0;
  std::size_t next = 0;
  for (const JointCell& cell : cells) {
    const double by = time_over(leg, cell);
    for (; next < ends_.size() && ends_[next] <= time + by; ++next) {
      ends_[next] = cell.begin + (cell.end - cell.begin) * (ends_[next] - time) / by;
    }
    time += by;
  }
  ends_.resize(std::min(next + 1, ends_.size()));
  ends_.back() = leg.path.length;
  for (const JointCell* rest : {&cells.front(), &cells.back()}) {
    grade_from_rest(ends_, length_from_rest(*rest), finer_);
    ends_.swap(finer_);
    turn_round(ends_, leg.path.length);
  }
}

double LegFeed::length_from_rest(const JointCell& rest) const noexcept {
  const FeedLimits& limits = feed_.limits();
  double per_jerk = 0;
  for (int i = 0; i < limits.count; ++i) {
    per_jerk = std::max(per_jerk, rest.d1[i] / limits.jerk[i]);
  }
  constexpr double kRest_s = CellSettings{}.rest_s;
  return std::max(CellGrid::kMinRest_mm, kRest_s * kRest_s * kRest_s / (6 * per_jerk));
}

bool LegFeed::push_cells(const Leg& leg, Times& times, Staging& out) noexcept {
  FeedSpan span;
  span.path = leg.path;
  span.feed_mm_per_s = leg.max_tip_speed();
  if (leg.share_per_s > 0) {
    span.u_speed_mm_per_s = leg.feed_factor * leg.share_per_s * leg.path.length;
  }
  span.cells = 1;
  for (const double end : ends_) {
    span.length = end - span.begin;
    if (!feed_.has_room() && !stage_windows(times, out)) return false;
    if (!feed_.has_room() || is_fault(feed_.push(span))) return false;
    span.begin = end;
  }
  return !is_fault(feed_.finish());
}

bool LegFeed::stage_windows(Times& times, Staging& out) noexcept {
  const std::int64_t crawls = feed_.count().crawls;
  while (feed_.try_plan()) {
    if (feed_.count().crawls > crawls) return false;  // constant bounds do better
    const FeedWindow& window = feed_.window();
    stop_margin_.begin(feed_.grid(), feed_.grid().last());
    for (const FeedPiece& piece : window.committed) {
      TimePiece time = times.names;
      put_law(piece, time);
      stop_margin_.grant(piece, time);
      times.duration += time.duration;
      if (!(times.duration < times.less_than_s) || !out.add(time)) return false;
    }
  }
  return !is_fault(feed_.fault());
}

double min_leg_time(const Leg& leg, std::span<const JointCell> cells,
                    const JointCaps& caps) noexcept {
  PathLimits easiest;
  double at_speed = 0;
  for (const JointCell& cell : cells) {
    double per_s = 1 / leg.max_velocity(cell.share_rate);
    for (int i = 0; i < caps.count; ++i) per_s = std::max(per_s, cell.d1[i] / caps.velocity[i]);
    at_speed += per_s * (cell.end - cell.begin);
    easiest.acceleration = std::max(easiest.acceleration, find_acceleration({&cell, 1}, caps, 0));
    easiest.jerk = std::max(easiest.jerk, find_jerk({&cell, 1}, caps, 0, 0));
  }
  easiest.velocity = leg.path.length / at_speed;
  return std::max(duration_with_room(leg.path.length, easiest), at_speed);
}

}  // namespace meridian
