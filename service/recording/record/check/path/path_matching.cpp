// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/path_matching.hpp"

#include <algorithm>

#include "meridian/path/path_piece.hpp"
#include "service/recording/record/check/check_report.hpp"

namespace meridian::record {
namespace {

constexpr double kNone = Interval::kNone;
constexpr double kWithin = 1 + kRoundingShare;
/// Beyond this factor on the tolerances, and again at its doubles, the path ahead is looked at.
constexpr double kFirstLook = 2;
/// Beyond it the tool is nowhere near.
constexpr double kWidest = 16;
constexpr double kFactorStep = 1.01;
/// So many elements ahead are looked at.
constexpr std::size_t kLookAhead = 10'000;
/// As often it is looked at right where the matching is lost: who is always about there costs time.
constexpr int kEarlyLooks = 1000;
constexpr double kLongestLookStep_mm = 1;

/// What the element takes at least, s.
[[nodiscard]] double min_time(const PathElement& element, const PathMatching::Gap& gap) {
  const auto rate = [&gap](double asked, double fastest) {
    return asked > 0 ? std::min(gap.factor * asked, fastest) : fastest;
  };
  return std::max(element.tip_length() / rate(element.feed_mm_per_s, gap.fastest_mm_per_s),
                  element.axis_turn / rate(element.turn_rad_per_s, gap.fastest_rad_per_s));
}

[[nodiscard]] bool is_reached(const Interval& cell) { return !cell.is_empty(); }

[[nodiscard]] bool is_any_reached(const std::vector<Interval>& cells) {
  return std::any_of(cells.begin(), cells.end(), is_reached);
}

}  // namespace

VertexPass& PathMatching::vertex(std::size_t index) {
  while (first_vertex_ + vertices_.size() <= index) {
    vertices_.push_back({.index = first_vertex_ + vertices_.size()});
  }
  return vertices_[index - first_vertex_];
}

/// Where on the chord the vertex can be passed at the earliest: `is_left`: from an element that was
/// reached at the last pose; else on from `entry`, where the vertex before was passed. The tool is
/// that of the element which ends there. Notes how near the chord comes, however far that is.
double PathMatching::cross_vertex(std::size_t index, bool is_left, double entry, double factor) {
  const PathElement& element = elements_[index == 0 ? 0 : index - 1];
  const ToolPose want = element.pose(index == 0 ? 0 : 1);
  const ToolPose from = here_.with_tool(element.tool_length_mm);
  const ToolPose to = next_.with_tool(element.tool_length_mm);
  VertexPass& pass = vertex(index);
  const double nearest = (to.tip - want.tip).norm() - (to.tip - from.tip).norm();
  const double reach = factor * tolerance_.tip_mm + kSag_mm;
  if (nearest > reach && nearest > pass.share * tolerance_.tip_mm) return kNone;
  const double begin = is_left ? 0 : entry;
  Interval free = free_on_chord(want, from, to, {reach, factor * tolerance_.axis_rad});
  free.cut(begin, 1);
  const Interval within = free.is_empty() ? Interval{begin, 1} : free;
  const PoseMatch match = best_on_chord(want, from, to, within, tolerance_);
  const double share = match.share(tolerance_);
  if (share < pass.share) {
    pass.share = share;
    pass.tip_mm = match.tip_mm;
    pass.axis_rad = match.axis_rad;
  }
  return free.is_empty() ? kNone : free.low;
}

/// From the column of here_ to that of next_ by `factor` times the tolerances.
bool PathMatching::reach(double factor) {
  const Tolerance tolerance{factor * tolerance_.tip_mm, factor * tolerance_.axis_rad};
  ahead_.clear();
  double entry = has_begun_ ? kNone : cross_vertex(0, true, 0, factor);
  for (std::size_t n = 0; first_ + n < elements_.size(); ++n) {
    const bool is_left = n < cells_.size() && is_reached(cells_[n]);
    const bool is_entered = entry < kNone;
    if (!is_left && !is_entered && n >= cells_.size()) break;
    Interval reached = Interval::none();
    double up = kNone;
    if (is_left || is_entered) {
      const PathElement& element = elements_[first_ + n];
      reached = free_on(element, next_.with_tool(element.tool_length_mm), tolerance);
      if (!is_entered) reached.cut(cells_[n].low, 1);
      up = cross_vertex(first_ + n + 1, is_left, entry, factor);
    }
    ahead_.push_back(reached);
    entry = up;
  }
  is_at_end_ = first_ + ahead_.size() == elements_.size() && entry < kNone;
  return is_any_reached(ahead_);
}

/// What the tool may have come to while nobody looked: all from lowest() on, behind `from` as far
/// as the time allows.
void PathMatching::extend(const Gap& gap, Position from) {
  const Position low = lowest();
  double left = gap.time_s + from.t * min_time(elements_[from.element], gap);
  for (std::size_t i = low.element; i < elements_.size() && left >= 0; ++i) {
    const PathElement& element = elements_[i];
    while (first_ + ahead_.size() <= i) ahead_.push_back(Interval::none());
    Interval& reached = ahead_[i - first_];
    reached = free_on(element, next_.with_tool(element.tool_length_mm), tolerance_);
    if (i == low.element) reached.cut(low.t, 1);
    if (i >= from.element) {
      const double min = min_time(element, gap);
      if (min > left) reached.cut(0, left / min);
      left -= min;
    }
    if (left >= 0) vertex(i + 1).is_in_gap = true;
  }
}

void PathMatching::pass_below_first() {
  if (first_ < first_vertex_) return;
  static_cast<void>(vertex(first_));
  const auto end = vertices_.begin() + static_cast<std::ptrdiff_t>(first_ + 1 - first_vertex_);
  passed_.insert(passed_.end(), vertices_.begin(), end);
  vertices_.erase(vertices_.begin(), end);
  first_vertex_ = first_ + 1;
}

/// The next column becomes the last one; what was left below goes.
void PathMatching::adopt() {
  const auto low = std::find_if(ahead_.begin(), ahead_.end(), is_reached);
  const auto below = static_cast<std::size_t>(low - ahead_.begin());
  while (!is_reached(ahead_.back())) ahead_.pop_back();
  cells_.assign(low, ahead_.end());
  first_ += below;
  here_ = next_;
  has_begun_ = true;
  pass_below_first();
}

/// The least factor that reaches something, and what that is. False: none does.
bool PathMatching::widen() {
  double low = kWithin, high = kNone;
  if (factor_ > kWithin) (reach(factor_) ? high : low) = factor_;
  if (high == kNone) {
    for (high = 1.25 * low; !reach(high); high *= 1.5) {
      if (high > kWidest) return false;
      low = high;
    }
  }
  while (high > kFactorStep * low) {
    const double middle = 0.5 * (low + high);
    (reach(middle) ? high : low) = middle;
  }
  factor_ = high;
  return reach(high);
}

/// Goes on with the next element ahead that the pose is within tolerance of. Vertices on the way
/// there that nobody looked at were missed with the ones before them.
bool PathMatching::resume() {
  const std::size_t end = std::min(elements_.size(), first_ + kLookAhead);
  for (std::size_t i = first_; i < end; ++i) {
    const PathElement& element = elements_[i];
    Interval free = free_on(element, next_.with_tool(element.tool_length_mm), tolerance_);
    if (i == first_ && !cells_.empty()) free.cut(cells_.front().low, 1);
    if (free.is_empty()) continue;
    static_cast<void>(vertex(i));
    for (std::size_t n = 1; n < vertices_.size() && vertices_[n].index <= i; ++n) {
      if (vertices_[n].share < kNone) continue;
      const std::size_t index = vertices_[n].index;
      vertices_[n] = vertices_[n - 1];
      vertices_[n].index = index;
    }
    ahead_.assign(1, free);
    first_ = i;
    adopt();
    factor_ = 1;
    look_at_factor_ = kFirstLook;
    return true;
  }
  return false;
}

/// Nothing is reached within tolerance. The path ahead comes first: who passes a vertex outside the
/// tolerance is lost no sooner than behind it.
PathMatching::Step PathMatching::recover() {
  is_broken_ = true;
  if (factor_ <= kWithin && early_looks_ < kEarlyLooks) {
    ++early_looks_;
    if (resume()) return Step::kResumed;
  }
  const bool is_widened = widen();
  if (is_widened && factor_ < look_at_factor_) {
    adopt();
    return Step::kWidened;
  }
  if (resume()) return Step::kResumed;
  look_at_factor_ = 2 * factor_;
  if (is_widened && reach(factor_)) {
    adopt();
    return Step::kWidened;
  }
  is_astray_ = true;
  looked_from_ = here_ = next_;
  look_step_mm_ = tolerance_.tip_mm;
  return Step::kAstray;
}

PathMatching::Step PathMatching::look_for_it() {
  here_ = next_;
  const double moved = (next_.gauge - looked_from_.gauge).norm() +
                       kAxisLength_mm_per_rad * (next_.axis - looked_from_.axis).norm();
  if (moved < look_step_mm_) return Step::kAstray;
  looked_from_ = next_;
  look_step_mm_ = std::min(1.1 * look_step_mm_, std::max(kLongestLookStep_mm, tolerance_.tip_mm));
  is_astray_ = !resume();
  return is_astray_ ? Step::kAstray : Step::kResumed;
}

PathMatching::Step PathMatching::move(const GaugePose& pose, const Tolerance& tolerance) {
  next_ = pose;
  tolerance_ = tolerance;
  if (!has_begun_ && !is_astray_) here_ = next_;
  if (is_astray_) return look_for_it();
  if (!reach(kWithin)) return recover();
  adopt();
  factor_ = 1;
  look_at_factor_ = kFirstLook;
  return Step::kWithin;
}

PathMatching::Step PathMatching::cross(const GaugePose& pose, const Tolerance& tolerance,
                                       const Gap& gap) {
  if (!has_begun_ || is_astray_) return move(pose, tolerance);
  next_ = pose;
  tolerance_ = tolerance;
  static_cast<void>(reach(kWithin));
  extend(gap, highest());
  if (!is_any_reached(ahead_)) return recover();
  adopt();
  return Step::kWithin;
}

bool PathMatching::finish() {
  if (!has_begun_ || is_astray_) return false;
  next_ = here_;
  if (!reach(kWithin)) return false;
  const bool is_at_end = is_at_end_;
  adopt();
  return is_at_end;
}

PathMatching::Position PathMatching::lowest() const noexcept {
  return cells_.empty() ? Position{} : Position{first_, cells_.front().low};
}

PathMatching::Position PathMatching::highest() const noexcept {
  return cells_.empty() ? Position{} : Position{first_ + cells_.size() - 1, cells_.back().high};
}

PoseMatch PathMatching::best() const {
  PoseMatch best{0, kNone, kNone};
  const auto take = [&](std::size_t index, const Interval& cell) {
    const PathElement& element = elements_[index];
    const PoseMatch match =
        best_on(element, cell, here_.with_tool(element.tool_length_mm), tolerance_);
    if (match.share(tolerance_) < best.share(tolerance_)) best = match;
  };
  if (cells_.empty()) take(0, {0, 0});
  for (std::size_t n = 0; n < cells_.size(); ++n) {
    if (is_reached(cells_[n])) take(first_ + n, cells_[n]);
  }
  return best;
}

}  // namespace meridian::record
