// SPDX-License-Identifier: Apache-2.0
#include "service/record/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/path_piece.hpp"

namespace meridian::record {
namespace {

/// A match this good, in tolerances, right where the pose is expected needs no further search.
constexpr double kPlainlyOn = 0.02;
/// What a place off the expected one counts for, in tolerances: decides between equals only.
constexpr double kPlaceWeight = 0.01;
constexpr double kLeastReach_mm = 0.05;
/// A match this far off, in tolerances, may be on the way out of a path that has turned round.
constexpr double kDoubtful = 0.5;
/// What lies between such a match and the way back, in tolerances: at most that of the tool's turn,
/// that of the earliest place, and what either is off, there and back.
constexpr double kTurnReach = 8;
/// Least squares of both deviations that far off: the larger of them is more than 1 everywhere.
constexpr double kSurelyOff = 1.5;
/// An arc of 15 deg is longer than its chord by less than that.
constexpr double kArcShare = 1.01;

}  // namespace

PathFollower::PathFollower(const CheckedPath& path, double tip_tolerance_mm,
                           double axis_tolerance_rad)
    : path_(path), tip_tolerance_(tip_tolerance_mm), axis_tolerance_(axis_tolerance_rad) {}

double PathFollower::measure(const ToolPose& pose, std::size_t index, double t) const noexcept {
  const ToolPose want = path_.elements()[index].pose(t);
  return std::max((pose.tip - want.tip).norm() / tip_tolerance_,
                  angle_between(pose.axis, want.axis) / axis_tolerance_);
}

PoseMatch PathFollower::match_at(const ToolPose& pose, std::size_t index, double t) const {
  const PathElement& element = path_.elements()[index];
  const ToolPose want = element.pose(t);
  return {index, t, element.s + t * element.length, (pose.tip - want.tip).norm(),
          angle_between(pose.axis, want.axis)};
}

/// Least squares of both deviations in tolerances: three Gauss-Newton steps from `t`.
double PathFollower::project(const ToolPose& pose, std::size_t index, double t) const noexcept {
  const PathElement& element = path_.elements()[index];
  const double tip_weight = 1 / (tip_tolerance_ * tip_tolerance_);
  const double axis_weight = 1 / (axis_tolerance_ * axis_tolerance_);
  for (int step = 0; step < 3; ++step) {
    const ToolPose want = element.pose(t), slope = element.slope(t);
    const double down = tip_weight * slope.tip.dot(pose.tip - want.tip) +
                        axis_weight * slope.axis.dot(pose.axis - want.axis);
    const double bend =
        tip_weight * slope.tip.squaredNorm() + axis_weight * slope.axis.squaredNorm();
    if (!(bend > 0)) return t;
    const double next = std::clamp(t + down / bend, 0.0, 1.0);
    if (std::abs(next - t) < 1e-15) return next;
    t = next;
  }
  return t;
}

double PathFollower::length_at(const Place& place) const noexcept {
  if (path_.elements().empty()) return 0;
  const PathElement& element = path_.elements()[place.element];
  return element.s + place.t * element.length;
}

/// Coarse: five places on each element within reach.
PoseMatch PathFollower::scan(const ToolPose& pose, double reach, double place_weight,
                             double expected) const {
  const auto& elements = path_.elements();
  const std::size_t low = path_.element_at(here_.s - 0.2 * reach - 0.02);
  const std::size_t high = std::min(path_.element_at(here_.s + reach) + 1, elements.size() - 1);
  PoseMatch best = here_;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t index = std::max(low > 0 ? low - 1 : 0, earliest_.element); index <= high;
       ++index) {
    const double begin = begin_of(index);
    for (const double start : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const double near = elements[index].length > 0.02 ? project(pose, index, start) : start;
      const double t = std::max(near, begin);
      const double s = elements[index].s + t * elements[index].length;
      const double cost =
          measure(pose, index, t) + place_weight * std::abs(s - expected) / (0.1 * reach);
      if (cost >= least) continue;
      least = cost;
      best = {index, t, s, 0, 0};
    }
  }
  return best;
}

/// Golden section of max(tip, axis) over one element.
PoseMatch PathFollower::refine(const ToolPose& pose, std::size_t index) const {
  constexpr double kGolden = 0.6180339887498949;
  const double begin = begin_of(index);
  double low = begin, high = 1;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = measure(pose, index, left), at_right = measure(pose, index, right);
  for (int step = 0; step < 60; ++step) {
    if (at_left <= at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = measure(pose, index, left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = measure(pose, index, right);
    }
  }
  double best = 0.5 * (low + high);
  for (const double t : {begin, 1.0, std::max(begin, project(pose, index, best))}) {
    if (measure(pose, index, t) < measure(pose, index, best)) best = t;
  }
  return match_at(pose, index, best);
}

/// The best match near a coarse one.
PoseMatch PathFollower::find_best(const ToolPose& pose, const PoseMatch& coarse) const {
  PoseMatch match = match_at(pose, coarse.element, coarse.t);
  if (badness(match) <= kPlainlyOn) return match;
  const std::size_t last = std::min(coarse.element + 1, path_.elements().size() - 1);
  const std::size_t before = coarse.element > 0 ? coarse.element - 1 : 0;
  for (std::size_t index = std::max(before, earliest_.element); index <= last; ++index) {
    const PoseMatch better = refine(pose, index);
    if (badness(better) < badness(match)) match = better;
  }
  return match;
}

PoseMatch PathFollower::search(const ToolPose& pose, double moved) const {
  const double expected = here_.s + moved, reach = 10 * moved + kLeastReach_mm;
  const PoseMatch near = find_best(pose, scan(pose, reach, kPlaceWeight, expected));
  const double off = badness(near);
  if (off <= kDoubtful) return near;
  const double tolerance = tip_tolerance_ + kAxisLength_mm_per_rad * axis_tolerance_;
  const PoseMatch far = find_best(pose, scan(pose, reach + kTurnReach * tolerance, 0, expected));
  const double far_off = badness(far);
  return far_off < 0.5 * off || (off > 1 && far_off < off) ? far : near;
}

/// The pose is `off` tolerances from the path at `t`: what lies before that by more than a
/// tolerance and `off` is farther from it than a tolerance.
void PathFollower::leave_behind(std::size_t index, double t, double off) noexcept {
  const PathElement& element = path_.elements()[index];
  const double tolerances =
      std::max(element.tip_length() / tip_tolerance_, element.axis_turn / axis_tolerance_);
  if (!(tolerances > 0)) return;
  earliest_ = std::max(earliest_, Place{index, t - kArcShare * (1 + off) / tolerances});
}

void PathFollower::raise_earliest(const ToolPose& pose, const PoseMatch& match) noexcept {
  for (; earliest_.element < match.element; earliest_ = {earliest_.element + 1, 0}) {
    const double t = std::max(project(pose, earliest_.element, earliest_.t), earliest_.t);
    const double off = measure(pose, earliest_.element, t);
    if (off <= kSurelyOff) return leave_behind(earliest_.element, t, off);
  }
  leave_behind(match.element, match.t, badness(match));
}

PoseMatch PathFollower::match_begin(const ToolPose& pose, std::size_t index) const {
  return match_at(pose, index, project(pose, index, 0));
}

void PathFollower::jump(const ToolPose& pose, const PoseMatch& match) noexcept {
  last_ = pose;
  here_ = match;
  earliest_ = {match.element, match.t};
}

PoseMatch PathFollower::follow(const ToolPose& pose) {
  if (path_.elements().empty()) {
    return {0, 0, 0, (pose.tip - path_.begin().tip).norm(),
            angle_between(pose.axis, path_.begin().axis)};
  }
  if (is_first_) {
    is_first_ = false;
    last_ = pose;
    here_ = match_at(pose, 0, 0);
  }
  const double moved =
      (pose.tip - last_.tip).norm() + kAxisLength_mm_per_rad * angle_between(pose.axis, last_.axis);
  last_ = pose;
  const double expected = here_.s + moved;
  const std::size_t nearby = path_.element_at(std::min(expected, path_.length()));
  const double length = path_.elements()[nearby].length;
  const double start =
      length > 0 ? std::clamp((expected - path_.elements()[nearby].s) / length, 0.0, 1.0) : 0.0;
  PoseMatch match = match_at(pose, nearby, project(pose, nearby, start));
  const bool is_plain = badness(match) <= kPlainlyOn &&
                        std::abs(match.s - expected) <= 0.1 * moved + 1e-3 &&
                        Place{match.element, match.t} >= earliest_;
  if (!is_plain) match = search(pose, moved);
  raise_earliest(pose, match);
  here_ = match;
  return match;
}

}  // namespace meridian::record
