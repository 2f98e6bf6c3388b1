// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"

/// The box that the tool tip stays inside of, in the frame M of the machine's base: the table may
/// turn under it. Nothing here allocates or throws. Units: mm. RT: cycle.
/// Proof: tests/unit/kinematics/tip_box_test.cpp.
namespace meridian {

/// From `min` to `max` along X, Y, Z of M; the faces are allowed.
struct TipBox {
  bool is_set = false;
  Array3 min{}, max{};
  [[nodiscard]] bool operator==(const TipBox&) const = default;
};
static_assert(std::is_trivially_copyable_v<TipBox>);

/// mm; rounding of a tip on a face.
inline constexpr double kTipBoxRounding = 1e-9;
/// mm; no face is farther from the base's origin.
inline constexpr double kFarthestTip_mm = 1e6;

/// Whether the ends of `box` are numbers, the minimum below the maximum, along each axis.
[[nodiscard]] inline bool is_tip_box(const TipBox& box) noexcept {
  for (std::size_t i = 0; i < box.min.size(); ++i) {
    const bool is_right = std::abs(box.min[i]) <= kFarthestTip_mm &&
                          std::abs(box.max[i]) <= kFarthestTip_mm && box.min[i] < box.max[i];
    if (!is_right) return false;
  }
  return true;
}

/// Whether `inner` is nowhere outside of `outer`; of an `outer` that is not set it is not.
[[nodiscard]] inline bool is_within(const TipBox& inner, const TipBox& outer) noexcept {
  for (std::size_t i = 0; outer.is_set && i < outer.min.size(); ++i) {
    if (inner.min[i] < outer.min[i] || inner.max[i] > outer.max[i]) return false;
  }
  return true;
}

/// How far `at` is outside of `box` along `axis`; not positive inside.
[[nodiscard]] inline double beyond_face(const TipBox& box, std::size_t axis, double at) noexcept {
  return std::max(box.min[axis] - at, at - box.max[axis]);
}

/// The first axis along which `tip` is farther than `margin` outside of `box`, or not a number; -1:
/// it is inside, or there is no box.
[[nodiscard]] inline int axis_outside(const TipBox& box, const Array3& tip,
                                      double margin = kTipBoxRounding) noexcept {
  for (std::size_t i = 0; box.is_set && i < tip.size(); ++i) {
    if (!(beyond_face(box, i, tip[i]) <= margin)) return static_cast<int>(i);
  }
  return -1;
}

/// The first axis along which a tip at `now` is outside of `box`, and farther than it was at
/// `before`: whoever stands outside may come in, and stand. -1: none.
[[nodiscard]] inline int axis_leaving(const TipBox& box, const Array3& now, const Array3& before,
                                      double margin) noexcept {
  constexpr double kStands = 1e-11;  // of a tip that stands
  for (std::size_t i = 0; box.is_set && i < now.size(); ++i) {
    const double was = beyond_face(box, i, before[i]);
    if (!(beyond_face(box, i, now[i]) <= std::max(margin, was + kStands))) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

/// A coordinate of the tip at both ends of a step, with its derivatives by the parameter.
struct TipStep {
  double from, to;              ///< mm
  double from_slope, to_slope;  ///< first derivatives
  double bend;                  ///< the largest amount of the second derivative over the step
};

/// How far a coordinate comes outside of the box, along `axis`, over a step of length `h`: beyond
/// both ends it goes only where it turns round, and by no more than h²/8 of its second derivative.
/// Infinite where `bend` is not finite.
[[nodiscard]] inline double beyond_over_step(const TipBox& box, std::size_t axis,
                                             const TipStep& step, double h) noexcept {
  const double reach = 0.5 * h * step.bend;  // of the first derivative, by the middle of the step
  const bool turns = !(step.from_slope * step.to_slope > 0 && std::abs(step.from_slope) >= reach &&
                       std::abs(step.to_slope) >= reach);
  const double off = turns ? 0.25 * h * reach : 0;
  const double out = std::max(beyond_face(box, axis, step.from), beyond_face(box, axis, step.to));
  return std::isfinite(reach) ? out + off : std::numeric_limits<double>::infinity();
}

/// A coordinate of the tip while one joint moves by δ, the others at rest: t + s δ of a linear
/// joint, t + s sin δ + b (1 - cos δ) of a rotary one.
struct TipCircle {
  double at = 0, slope = 0, bend = 0;  ///< t, s, b
  bool is_rotary = false;
};

namespace tip_box {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// Whether the joint does not move the coordinate, but for rounding.
[[nodiscard]] inline bool is_still(const TipCircle& t) noexcept {
  constexpr double kStill = 1e-12, kStill_mm = 1e-9;
  return t.is_rotary ? hypot(t.slope, t.bend) < kStill_mm : std::abs(t.slope) < kStill;
}

/// The first δ >= 0 at which the coordinate of a rotary joint passes `room` beyond where it is
/// upwards; infinite where it never does. `sign` -1: downwards.
[[nodiscard]] inline double find_crossing(const TipCircle& t, double room, double sign) noexcept {
  constexpr double kTurn = 6.283185307179586, kRounding_rad = 1e-9;
  const double slope = sign * t.slope, bend = sign * t.bend, r = hypot(slope, bend);
  if (!(std::abs(room - bend) < r)) return kNever;
  // It is there where slope sin δ - bend cos δ = room - bend.
  const double side = std::sqrt(std::max(0.0, (r - room + bend) * (r + room - bend)));
  const double angle = atan2(slope, -bend) - atan2(side, room - bend);
  if (angle >= 0) return angle;
  return angle > -kRounding_rad ? 0 : angle + kTurn;
}

/// The first δ >= 0 at which the coordinate passes `face` outwards (`sign` 1: upwards), coming from
/// the inside or from on it.
[[nodiscard]] inline double find_exit(const TipCircle& t, double face, double sign) noexcept {
  const double room = std::max(0.0, sign * (face - t.at)), slope = sign * t.slope;
  if (!t.is_rotary) return slope > 0 ? room / slope : kNever;
  // On the face at the turning point of the circle, but for rounding, it goes out to either side.
  const double bend = sign * t.bend;
  const bool is_at_once = slope > 0 || (bend > 0 && room - bend <= -hypot(slope, bend));
  return room <= kTipBoxRounding && is_at_once ? 0 : find_crossing(t, room, sign);
}

/// The same of a coordinate that is outside of `face` (`sign` 1: above it): where it goes out again
/// after it came in, or where it comes no farther in.
[[nodiscard]] inline double find_end(const TipCircle& t, double face, double sign) noexcept {
  const double slope = sign * t.slope;
  if (!(slope < 0)) return 0;
  if (!t.is_rotary) return kNever;
  const double again = find_crossing(t, sign * (face - t.at), sign);
  return std::isfinite(again) ? again : atan2(-slope, sign * t.bend);
}

/// How far the joint may move to the side for which `t` is given.
[[nodiscard]] inline double find_room(const TipBox& box, std::size_t axis,
                                      const TipCircle& t) noexcept {
  if (is_still(t)) return kNever;
  const double below = box.min[axis] - t.at, above = t.at - box.max[axis];
  const double low =
      below > kTipBoxRounding ? find_end(t, box.min[axis], -1) : find_exit(t, box.min[axis], -1);
  const double high =
      above > kTipBoxRounding ? find_end(t, box.max[axis], 1) : find_exit(t, box.max[axis], 1);
  return std::min(low, high);
}

}  // namespace tip_box

/// Narrows [low, high], in which a joint may go from where it is, `q`, while the others stand
/// still, to what `box` leaves of it along `axis`.
inline void narrow_inside(const TipBox& box, std::size_t axis, const TipCircle& t, double q,
                          double& low, double& high) noexcept {
  const TipCircle back{t.at, -t.slope, t.bend, t.is_rotary};
  high = std::min(high, q + tip_box::find_room(box, axis, t));
  low = std::max(low, q - tip_box::find_room(box, axis, back));
}

}  // namespace meridian
