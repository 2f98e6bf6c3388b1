// SPDX-License-Identifier: Apache-2.0
#include "service/record/path_follower.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/path_piece.hpp"

namespace meridian::record {
namespace {

/// A match this good, in tolerances, right where the pose is expected needs no further search.
constexpr double kPlainlyOn = 0.02;
/// What a place off the expected one counts for, in tolerances: decides between equals only.
constexpr double kPlaceWeight = 0.01;
constexpr double kLeastReach_mm = 0.05;

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

std::size_t PathFollower::element_at(double s) const noexcept {
  const auto& elements = path_.elements();
  const auto after =
      std::upper_bound(elements.begin(), elements.end(), s,
                       [](double value, const PathElement& element) { return value < element.s; });
  return after == elements.begin() ? 0 : static_cast<std::size_t>(after - elements.begin()) - 1;
}

/// Coarse: five places on each element within reach.
PoseMatch PathFollower::scan(const ToolPose& pose, double reach, double expected) const {
  const auto& elements = path_.elements();
  const std::size_t low = element_at(here_.s - 0.2 * reach - 0.02);
  const std::size_t high = std::min(element_at(here_.s + reach) + 1, elements.size() - 1);
  PoseMatch best = here_;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t index = low > 0 ? low - 1 : 0; index <= high; ++index) {
    for (const double start : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const double t = elements[index].length > 0.02 ? project(pose, index, start) : start;
      const double s = elements[index].s + t * elements[index].length;
      const double cost =
          measure(pose, index, t) + kPlaceWeight * std::abs(s - expected) / (0.1 * reach);
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
  double low = 0, high = 1;
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
  for (const double t : {0.0, 1.0, project(pose, index, best)}) {
    if (measure(pose, index, t) < measure(pose, index, best)) best = t;
  }
  return match_at(pose, index, best);
}

PoseMatch PathFollower::match_begin(const ToolPose& pose, std::size_t index) const {
  return match_at(pose, index, project(pose, index, 0));
}

void PathFollower::jump(const ToolPose& pose, const PoseMatch& match) noexcept {
  last_ = pose;
  here_ = match;
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
  const std::size_t nearby = element_at(std::min(expected, path_.length()));
  const double length = path_.elements()[nearby].length;
  const double start =
      length > 0 ? std::clamp((expected - path_.elements()[nearby].s) / length, 0.0, 1.0) : 0.0;
  PoseMatch match = match_at(pose, nearby, project(pose, nearby, start));
  if (badness(match) > kPlainlyOn || std::abs(match.s - expected) > 0.1 * moved + 1e-3) {
    const PoseMatch coarse = scan(pose, 10 * moved + kLeastReach_mm, expected);
    match = match_at(pose, coarse.element, coarse.t);
    if (badness(match) > kPlainlyOn) {
      const std::size_t last = path_.elements().size() - 1;
      const std::size_t low = coarse.element > 0 ? coarse.element - 1 : 0;
      for (std::size_t index = low; index <= std::min(coarse.element + 1, last); ++index) {
        const PoseMatch better = refine(pose, index);
        if (badness(better) < badness(match)) match = better;
      }
    }
  }
  here_ = match;
  return match;
}

}  // namespace meridian::record
