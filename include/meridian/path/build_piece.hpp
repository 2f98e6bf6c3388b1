// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/path/path_piece.hpp"

/// From CL blocks to path pieces: geometry alone; who the piece belongs to and which joints follow
/// it is filled in by the planner. Frame: W. Units: mm, rad. Proof: tests/unit/path.
namespace meridian {

/// A straight path of the tip with the axis on the great circle. The axes are unit vectors and not
/// opposite (find_great_circle() checks it).
[[nodiscard]] PathPiece make_line(const ToolPose& begin, const ToolPose& end) noexcept;

/// The arc or helix of `block` from `begin`. Radius and begin are those of the actual begin; what
/// the block's rounded centre leaves open at its end is spread evenly over the arc, so that it ends
/// on the block's tip to rounding.
[[nodiscard]] PathPiece make_arc(const ToolPose& begin, const ToolPose& end,
                                 const ClBlock& block) noexcept;

/// Where an arc block starts that ends on its tip: for a program that begins with an arc.
[[nodiscard]] Vector3 find_arc_begin(const ClBlock& block) noexcept;

/// A turn of the redundant joint at `pose` on the pole. Its length is 50 mm per rad.
[[nodiscard]] PathPiece make_turn(const ToolPose& pose, double free_begin,
                                  double free_end) noexcept;

/// Every joint evenly from `begin` to `end`. Bits of `rotary_mask` mark joints in rad.
[[nodiscard]] PathPiece make_joint_move(const JointVector& begin, const JointVector& end,
                                        std::uint32_t rotary_mask) noexcept;

/// `piece` (kLine or kArc) with another route of the axis, and the path length that goes with it.
[[nodiscard]] PathPiece with_axes(const PathPiece& piece, const Vector3& begin,
                                  const Vector3& end) noexcept;

/// Length of the tip's way on `piece`, kLine or kArc; 0 for other kinds.
[[nodiscard]] double tip_length(const PathPiece& piece) noexcept;

/// The part of a kLine, kArc or kTurn piece between shares `from` < `to` of its length.
[[nodiscard]] PathPiece cut_piece(const PathPiece& piece, double from, double to) noexcept;

/// How the axis of a piece passes the pole: φ is the turn of the axis from its begin.
struct PolePassage {
  double nearest_turn = 0;  ///< φ of the point of the great circle nearest to the pole
  double offset = 0;        ///< sine of its distance to the pole, >= 0
};

/// Returns the passage of `piece` by the pole in direction `pole` (unit, W). The nearest point may
/// lie outside the piece. The axis of `piece` turns.
[[nodiscard]] PolePassage find_passage(const PathPiece& piece, const Vector3& pole) noexcept;

/// The part of a kLine or kArc piece between azimuths `from` < `to` about the pole (counted from
/// the nearest point, inside ±π/2), with s so that the azimuth grows evenly: 50 mm per rad.
[[nodiscard]] PathPiece cut_by_azimuth(const PathPiece& piece, const PolePassage& passage,
                                       double from, double to) noexcept;

}  // namespace meridian
