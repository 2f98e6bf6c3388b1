// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"

namespace meridian::record {
namespace {

/// Squares of lengths and turns below which an element or a chord stands still.
constexpr double kStill_mm2 = 1e-24;
constexpr double kStill_rad = 1e-12;
/// Beyond that a tolerance of the axis has no meaning, and its sine none either.
constexpr double kLargestAxis_rad = 1.4;
constexpr int kBisections = 50;

/// Where t ↦ |offset + t·delta| is at most `reach`.
[[nodiscard]] Interval within_reach(const Vector3& offset, const Vector3& delta, double reach) {
  const double square = delta.squaredNorm();
  if (square < kStill_mm2) {
    return offset.squaredNorm() <= reach * reach ? Interval{} : Interval::none();
  }
  const double t = -offset.dot(delta) / square;
  const double rest = reach * reach - (offset + t * delta).squaredNorm();
  if (rest < 0) return Interval::none();
  const double half = std::sqrt(rest / square);
  return {std::max(0.0, t - half), std::min(1.0, t + half)};
}

[[nodiscard]] double tip_distance(const PathElement& element, double t, const Vector3& tip) {
  return (element.pose(t).tip - tip).norm();
}

/// Parameter of the element's tip that is nearest to `tip`.
[[nodiscard]] double nearest_tip(const PathElement& element, const Vector3& tip) {
  const Vector3 offset = tip - element.tip_begin;
  if (element.arc_sweep == 0) {
    const double square = element.tip_delta.squaredNorm();
    return square < kStill_mm2 ? 0.0 : std::clamp(offset.dot(element.tip_delta) / square, 0.0, 1.0);
  }
  const double angle = std::atan2(offset.dot(element.arc_y), offset.dot(element.arc_x));
  double t = std::clamp(angle / element.arc_sweep, 0.0, 1.0);
  for (int step = 0; step < 6; ++step) {  // a rise moves it; least squares from the planar one
    const ToolPose slope = element.slope(t);
    const double square = slope.tip.squaredNorm();
    if (square < kStill_mm2) break;
    const double next = std::clamp(t + slope.tip.dot(tip - element.pose(t).tip) / square, 0.0, 1.0);
    if (std::abs(next - t) < 1e-15) break;
    t = next;
  }
  return t;
}

/// The parameter between `inside` and `outside` where the distance becomes `reach`.
[[nodiscard]] double edge(const PathElement& element, const Vector3& tip, double reach,
                          double inside, double outside) {
  if (tip_distance(element, outside, tip) <= reach) return outside;
  for (int step = 0; step < kBisections; ++step) {
    const double middle = 0.5 * (inside + outside);
    (tip_distance(element, middle, tip) <= reach ? inside : outside) = middle;
  }
  return inside;
}

/// The same on a flat arc of at most 15°, in closed form: at the angle δ off the nearest point of
/// its circle the distance² is height² + (R - ρ)² + 4 R ρ sin²(δ/2), ρ from the centre to the tip.
[[nodiscard]] Interval within_flat_arc(const PathElement& element, const Vector3& tip,
                                       double reach) {
  const Vector3 offset = tip - element.tip_begin;
  const double square = element.arc_x.squaredNorm(), radius = std::sqrt(square);
  const double along = offset.dot(element.arc_x) / radius;
  const double across = offset.dot(element.arc_y) / radius;
  const double flat = std::hypot(along, across);
  const double height2 =
      (offset - (along * element.arc_x + across * element.arc_y) / radius).squaredNorm();
  const double rest = reach * reach - height2 - (radius - flat) * (radius - flat);
  if (rest < 0) return Interval::none();
  const double sine2 = rest / std::max(4 * radius * flat, kStill_mm2);
  if (sine2 >= 1) return {};
  const double half = 2 * std::asin(std::sqrt(sine2));
  const double at = std::atan2(across, along);
  Interval out{(at - half) / element.arc_sweep, (at + half) / element.arc_sweep};
  out.cut(0, 1);
  return out;
}

/// The same on an arc of at most 15°, flat or risen.
[[nodiscard]] Interval within_arc(const PathElement& element, const Vector3& tip, double reach) {
  const double fits = reach + 0.5 * element.tip_length();
  if ((element.pose(0.5).tip - tip).squaredNorm() > fits * fits) return Interval::none();
  if (element.tip_delta.squaredNorm() < kStill_mm2) return within_flat_arc(element, tip, reach);
  double nearest = nearest_tip(element, tip);
  for (const double t : {0.0, 1.0}) {
    if (tip_distance(element, t, tip) < tip_distance(element, nearest, tip)) nearest = t;
  }
  if (tip_distance(element, nearest, tip) > reach) return Interval::none();
  return {edge(element, tip, reach, nearest, 0), edge(element, tip, reach, nearest, 1)};
}

/// Of the unit vector `axis` against an element's great circle: cosine, sine, height over it.
struct OnCircle {
  double along, across, height;
  OnCircle(const PathElement& element, const Vector3& axis)
      : along(axis.dot(element.axis_begin)),
        across(axis.dot(element.axis_normal)),
        height(axis.dot(element.axis_begin.cross(element.axis_normal))) {}
};

/// A turn that is still, measured by the chord: exact down to zero.
[[nodiscard]] bool is_near(const Vector3& a, const Vector3& b, double angle) {
  const double chord = 2 * std::sin(angle / 2);
  return (a - b).squaredNorm() <= chord * chord;
}

[[nodiscard]] double nearest_axis(const PathElement& element, const Vector3& axis) {
  const OnCircle on(element, axis);
  double at = std::atan2(on.across, on.along);
  if (at < 0.5 * element.axis_turn - std::numbers::pi) at += 2 * std::numbers::pi;
  return std::clamp(at / element.axis_turn, 0.0, 1.0);
}

}  // namespace

void Interval::cut(double from, double to) noexcept {
  low = std::max(low, from);
  high = std::min(high, to);
}

double PoseMatch::share(const Tolerance& tolerance) const noexcept {
  return std::max(tip_mm / tolerance.tip_mm, axis_rad / tolerance.axis_rad);
}

Interval free_on(const PathElement& element, const ToolPose& pose, const Tolerance& tolerance) {
  Interval out = element.arc_sweep != 0 ? within_arc(element, pose.tip, tolerance.tip_mm)
                                        : within_reach(Vector3(element.tip_begin - pose.tip),
                                                       element.tip_delta, tolerance.tip_mm);
  if (out.is_empty()) return out;
  const double angle = std::min(tolerance.axis_rad, kLargestAxis_rad);
  if (element.axis_turn < kStill_rad) {
    return is_near(pose.axis, element.axis_begin, angle) ? out : Interval::none();
  }
  const OnCircle on(element, pose.axis);
  const double rest = std::sin(angle) * std::sin(angle) - on.height * on.height;
  if (rest < 0) return Interval::none();
  const double flat = on.along * on.along + on.across * on.across;
  const double half = std::asin(std::sqrt(std::min(1.0, rest / std::max(flat, 1e-300))));
  double at = std::atan2(on.across, on.along);
  if (at < 0.5 * element.axis_turn - std::numbers::pi) at += 2 * std::numbers::pi;
  out.cut((at - half) / element.axis_turn, (at + half) / element.axis_turn);
  return out;
}

Interval free_on_chord(const ToolPose& vertex, const ToolPose& from, const ToolPose& to,
                       const Tolerance& tolerance) {
  Interval out =
      within_reach(Vector3(from.tip - vertex.tip), Vector3(to.tip - from.tip), tolerance.tip_mm);
  if (out.is_empty()) return out;
  const double chord = 2 * std::sin(std::min(tolerance.axis_rad, kLargestAxis_rad) / 2);
  const Interval axis =
      within_reach(Vector3(from.axis - vertex.axis), Vector3(to.axis - from.axis), chord);
  out.cut(axis.low, axis.high);
  return out;
}

namespace {

/// Between two parameters, each the best for one of the deviations, where both weigh the same.
template <class At>
[[nodiscard]] PoseMatch balance(At&& at, double by_tip, double by_axis,
                                const Tolerance& tolerance) {
  const auto is_tip_larger = [&](const PoseMatch& match) {
    return match.tip_mm / tolerance.tip_mm >= match.axis_rad / tolerance.axis_rad;
  };
  PoseMatch tip = at(by_tip), axis = at(by_axis);
  if (is_tip_larger(tip)) return tip;
  if (!is_tip_larger(axis)) return axis;
  for (int step = 0; step < kBisections; ++step) {
    const PoseMatch middle = at(0.5 * (tip.t + axis.t));
    (is_tip_larger(middle) ? axis : tip) = middle;
  }
  return tip.share(tolerance) < axis.share(tolerance) ? tip : axis;
}

}  // namespace

PoseMatch best_on(const PathElement& element, const Interval& within, const ToolPose& pose,
                  const Tolerance& tolerance) {
  const auto at = [&](double t) -> PoseMatch {
    const ToolPose want = element.pose(t);
    return {t, (pose.tip - want.tip).norm(), angle_between(pose.axis, want.axis)};
  };
  const double by_tip = std::clamp(nearest_tip(element, pose.tip), within.low, within.high);
  if (element.axis_turn < kStill_rad) return at(by_tip);
  const double by_axis = std::clamp(nearest_axis(element, pose.axis), within.low, within.high);
  const bool is_still = element.arc_sweep == 0 && element.tip_delta.squaredNorm() < kStill_mm2;
  return is_still ? at(by_axis) : balance(at, by_tip, by_axis, tolerance);
}

PoseMatch best_on_chord(const ToolPose& vertex, const ToolPose& from, const ToolPose& to,
                        const Interval& within, const Tolerance& tolerance) {
  const Vector3 tip = to.tip - from.tip, axis = to.axis - from.axis;
  const auto at = [&](double t) -> PoseMatch {
    return {t, (from.tip + t * tip - vertex.tip).norm(),
            (from.axis + t * axis - vertex.axis).norm()};
  };
  const auto nearest = [&](const Vector3& offset, const Vector3& delta, double otherwise) {
    const double square = delta.squaredNorm();
    const double t = square < kStill_mm2 ? otherwise : -offset.dot(delta) / square;
    return std::clamp(t, within.low, within.high);
  };
  const double by_tip = nearest(Vector3(from.tip - vertex.tip), tip, within.low);
  return balance(at, by_tip, nearest(Vector3(from.axis - vertex.axis), axis, by_tip), tolerance);
}

}  // namespace meridian::record
