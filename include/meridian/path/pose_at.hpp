// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/path/path_piece.hpp"

/// From path length to tool pose. `S` is double or a Jet, so that derivatives along the path come
/// from the code that gives the pose. Frame: W. Units: mm, rad. Source: docs/motion.md.
namespace meridian {

/// Which share of the route between the ends of `piece` tip and axis have put behind at `s`.
/// RT: cycle.
template <class S>
[[nodiscard]] inline S fraction_at(const PathPiece& piece, const S& s) noexcept {
  const S share = s / piece.length;
  if (!piece.is_azimuthal) return share;
  const auto [sine, cosine] =
      sin_cos(S(piece.azimuth_begin + (piece.azimuth_end - piece.azimuth_begin) * share));
  return (atan2(S(piece.pole_offset * sine), cosine) - piece.azimuth_from) / piece.axis_turn;
}

/// Returns the quartic with coefficients `c`, lowest first, at `x`, by Horner's rule. RT: cycle.
template <class S>
[[nodiscard]] inline S quartic_at(const std::array<double, 5>& c, const S& x) noexcept {
  S sum = x * c[4] + c[3];
  for (int k = 2; k >= 0; --k) sum = sum * x + c[k];
  return sum;
}

/// The same, bit for bit but for the sign of zero, of a jet. Where it is the variable itself most
/// of its products are by 0 and 1. Proof: tests/unit/path/quartic_jet_test.cpp.
template <int N>
[[nodiscard]] inline Jet<N> quartic_at(const std::array<double, 5>& c, const Jet<N>& x) noexcept {
  bool is_variable = x.c[1] == 1;
  for (int n = 2; n <= N; ++n) is_variable = is_variable && x.c[n] == 0;
  if (!is_variable) return quartic_at<Jet<N>>(c, x);
  Jet<N> sum = Jet<N>::with_derivative(x.c[0] * c[4] + c[3], c[4]);
  for (int k = 2; k >= 0; --k) {
    for (int n = N; n > 0; --n) sum.c[n] = sum.c[n - 1] + sum.c[n] * x.c[0];
    sum.c[0] = sum.c[0] * x.c[0] + c[k];
  }
  return sum;
}

/// Returns tip and unit axis of `quartic` at `x`. Not defined where O is zero, which a band spline
/// never is: O stays within the axis tolerance of a unit vector.
/// RT: cycle. Source: docs/motion.md, section 1. Proof: tests/unit/path/pose_at_test.cpp.
template <class S>
[[nodiscard]] inline Pose<S> pose_on(const PoseQuartic& quartic, const S& x) noexcept {
  using std::sqrt;
  Pose<S> out;
  for (int i = 0; i < 3; ++i) out.tip[i] = quartic_at(quartic[i], x);
  const S o[3] = {quartic_at(quartic[3], x), quartic_at(quartic[4], x), quartic_at(quartic[5], x)};
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
