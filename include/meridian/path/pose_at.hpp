// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/path/path_piece.hpp"

/// From path length to tool pose. `S` is double or a Jet, so that derivatives along the path come
/// from the code that gives the pose. Frame: W. Units: mm, rad. Source: docs/motion.md.
namespace meridian {

/// Which share of the way between the ends of `piece` tip and axis have put behind at `s`.
/// RT: cycle.
template <class S>
[[nodiscard]] inline S fraction_at(const PathPiece& piece, const S& s) noexcept {
  const S share = s / piece.length;
  if (!piece.is_azimuthal) return share;
  const auto [sine, cosine] =
      sin_cos(S(piece.azimuth_begin + (piece.azimuth_end - piece.azimuth_begin) * share));
  return (atan2(S(piece.pole_offset * sine), cosine) - piece.azimuth_from) / piece.axis_turn;
}

/// Returns tip and unit axis of `quartic` at `x`. Not defined where O is zero, which a band spline
/// never is: O stays within the axis tolerance of a unit vector.
/// RT: cycle. Source: docs/motion.md, section 1. Proof: tests/unit/path/pose_at_test.cpp.
template <class S>
[[nodiscard]] inline Pose<S> pose_on(const PoseQuartic& quartic, const S& x) noexcept {
  using std::sqrt;
  const auto component = [&](int d) {
    const std::array<double, 5>& c = quartic[d];
    S sum = x * c[4] + c[3];
    for (int k = 2; k >= 0; --k) sum = sum * x + c[k];
    return sum;
  };
  Pose<S> out;
  for (int i = 0; i < 3; ++i) out.tip[i] = component(i);
  const S o[3] = {component(3), component(4), component(5)};
  const S shrink = 1.0 / sqrt(S(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]));
  for (int i = 0; i < 3; ++i) out.axis[i] = o[i] * shrink;
  return out;
}

/// Returns the quintic with Bernstein values `values` at the share `t` in [0, 1] of its range, by
/// de Casteljau: no power of a small length, nothing cancels. RT: cycle.
template <class S>
[[nodiscard]] inline S quintic_at(const FreeQuintic& values, const S& t) noexcept {
  std::array<S, 6> level;
  for (std::size_t n = 0; n < 6; ++n) level[n] = S(values[n]);
  for (std::size_t left = 5; left > 0; --left) {
    for (std::size_t n = 0; n < left; ++n) level[n] += (level[n + 1] - level[n]) * t;
  }
  return level[0];
}

/// Returns the tool pose of `piece` at path length `s` in [0, length].
///
/// A kJoint piece has no path of its own in W: its pose at the begin is returned, and joints_at()
/// is the function to ask. RT: cycle. Proof: tests/unit/path/pose_at_test.cpp.
template <class S>
[[nodiscard]] inline Pose<S> pose_at(const PathPiece& piece, const S& s) noexcept {
  Pose<S> out;
  const bool is_fixed = piece.kind == PathKind::kTurn || piece.kind == PathKind::kJoint;
  if (is_fixed || !(piece.length > 0)) {
    for (int i = 0; i < 3; ++i) {
      out.tip[i] = S(piece.tip_begin[i]);
      out.axis[i] = S(piece.axis_begin[i]);
    }
    return out;
  }
  if (piece.kind == PathKind::kSpline) return pose_on(piece.spline, s);
  const S x = fraction_at(piece, s);
  if (piece.kind == PathKind::kArc) {
    const auto [sine, cosine] = sin_cos(S(piece.arc_sweep * x));
    for (int i = 0; i < 3; ++i) {
      out.tip[i] = piece.arc_centre[i] + cosine * piece.arc_x[i] + sine * piece.arc_y[i] +
                   piece.tip_delta[i] * x;
    }
  } else {
    for (int i = 0; i < 3; ++i) out.tip[i] = piece.tip_begin[i] + piece.tip_delta[i] * x;
  }
  if (piece.axis_turn == 0) {
    for (int i = 0; i < 3; ++i) out.axis[i] = S(piece.axis_begin[i]);
  } else {
    const auto [sine, cosine] = sin_cos(S(piece.axis_turn * x));
    for (int i = 0; i < 3; ++i) {
      out.axis[i] = cosine * piece.axis_begin[i] + sine * piece.axis_normal[i];
    }
  }
  return out;
}

}  // namespace meridian
