// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/path/block_marks.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian {

enum class PathKind : std::uint8_t {
  kLine,   ///< tip straight, tool axis on the great circle
  kArc,    ///< tip on an arc or helix, tool axis on the great circle
  kJoint,  ///< every joint linear in s (approach, joint-space rapid)
  kTurn,   ///< on the pole: tip and axis fixed, the free rotary joint turns from `free_begin` to
           ///< `free_end`
  kSpline  ///< tip and axis on quartics in s, see `spline`
};

/// Quartics of tip and unnormalised axis: component d at x is the sum of c[d][k] x^k, d = 0..2 tip
/// (mm), d = 3..5 O (the tool axis is O/|O|).
using PoseQuartic = std::array<std::array<double, 5>, 6>;

/// Values of a quintic in Bernstein form: of a redundant joint over a kSpline piece, rad.
using FreeQuintic = std::array<double, 6>;

/// What the operator sees the machine do on a piece; the `kind` column of a recording.
enum class MotionKind : std::uint8_t {
  kApproach,
  kCut,
  kRapid,
  kPoleTurn,
  kRewind  ///< off the part, whole turns of the redundant joint, and back to the same position
};

/// A stretch of path as a function of the path length s in [0, length]: where, not when.
/// s is sqrt(tip length² + (50 mm/rad · axis turn)²), so that a pure rotation advances too. Frame:
/// W. Units: mm, rad. Trivially copyable: travels from the planner to the cycle in a ring.
struct PathPiece {
  std::uint64_t index = 0;     ///< counts all pieces of an epoch from 0; TimePiece refers to it
  std::uint64_t sequence = 0;  ///< CL block that it belongs to
  std::uint32_t line = 0;      ///< its source line
  PathKind kind = PathKind::kLine;
  MotionKind motion = MotionKind::kCut;
  std::uint8_t branch = 0;      ///< solution of the inverse kinematics that is followed
  bool is_free_driven = false;  ///< the free rotary joint runs evenly from `free_begin` to
                                ///< `free_end`, on kSpline as `free_quintic`, and the tilt follows
                                ///< it; kTurn always does
  bool is_azimuthal = false;    ///< beside the pole: not the turn of the axis but its azimuth about
                                ///< the pole grows evenly with s, see below
  std::uint16_t epoch = 0;      ///< as in TimePiece
  double length = 0;            ///< range of s
  double tool_length_mm = 0;    ///< gauge line to tip
  Array3 tip_begin{};           ///< kLine, kTurn
  Array3 tip_delta{};           ///< kLine: end - begin; kArc: rise along the normal
  Array3 axis_begin{0, 0, 1};   ///< tool axis at s = 0
  Array3 axis_normal{1, 0, 0};  ///< unit vector in the great circle's plane, normal to axis_begin
  double axis_turn = 0;  ///< angle of the great circle, rad: axis(s) = cos(φ) begin + sin(φ)
                         ///< normal, φ = turn·s/length
  Array3 arc_centre{};   ///< kArc: tip(s) = centre + cos(ψ) x + sin(ψ) y + rise·s/length, ψ =
                         ///< sweep·s/length
  Array3 arc_x{};        ///< centre to the arc's begin, radius long
  Array3 arc_y{};        ///< normal × arc_x
  double arc_sweep = 0;
  double free_begin = 0, free_end = 0;  ///< is_free_driven
  /// is_azimuthal: tip and axis stand at fraction x(s) of their way instead of s/length. With
  /// azimuth α = begin + (end - begin)·s/length, counted from the point of the great circle that is
  /// nearest to the pole, and o = sine of that distance: x = (atan2(o sin α, cos α) - from)/turn.
  double azimuth_begin = 0, azimuth_end = 0;
  double pole_offset = 0;   ///< o
  double azimuth_from = 0;  ///< atan2(o sin, cos) at azimuth_begin
  PoseQuartic spline{};  ///< kSpline: quartics in s; s is the parameter u of the spline, which is
                         ///< nearly, not exactly, the length named above
  /// kSpline where `is_free_driven`: the redundant joint over [0, length].
  FreeQuintic free_quintic{};
  FreeQuintic roll_quintic{};  ///< the roll, where that is driven besides the yaw
  JointVector
      joints_begin{};  ///< joints at s = 0, windings included: the reference of the first solve
  JointVector joints_end{};  ///< joints at s = length, windings included
  BlockMarks marks;          ///< blocks that end on the piece
};
static_assert(std::is_trivially_copyable_v<PathPiece>);

/// Length that a turn of the tool axis by one radian counts for in the path length s.
inline constexpr double kAxisLength_mm_per_rad = 50.0;

}  // namespace meridian
