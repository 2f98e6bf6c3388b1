// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/geometry/vector3.hpp"

namespace meridian::cl {

/// Most that the distances of an arc's two ends from its centre may differ, mm: the default tip
/// tolerance. Four decimals of an inch give 2.5e-3.
inline constexpr double kArcMismatch_mm = 0.01;

/// Ends of an arc that are nearer than this are one point, so the arc is a full circle, mm.
inline constexpr double kArcClosed_mm = 1e-6;

/// An arc or helix that passes exactly through its begin and its end.
struct Arc {
  enum class Status : std::uint8_t {
    kOk,
    kNoRadius,     ///< begins on its own axis, or has no axis
    kNotOneCircle  ///< the ends lie on circles whose radii differ by more than kArcMismatch_mm
  };
  Status status = Status::kOk;
  Vector3 centre = Vector3::Zero();  ///< in the plane of the begin
  Vector3 normal = Vector3::UnitZ();
  Vector3 end = Vector3::Zero();
  double radius = 0;
  double sweep_rad = 0;    ///< (0, 2π], right-handed about the normal
  double mismatch_mm = 0;  ///< radius at the end less radius at the begin, as written
};

/// The arc from `begin` to `end` about `centre`, right-handed about `normal` (any length but zero).
///
/// Files round centre and ends, so the two radii differ. The centre is moved onto the bisector of
/// the two ends where that moves the arc by no more than a few times the mismatch; else (nearly a
/// full circle) `Arc::end` is the point of the begin's circle nearest to `end`, and the caller goes
/// on to `end` on a line as long as the mismatch. Units: mm. Proof: tests/unit/cl/arc_test.cpp.
[[nodiscard]] Arc solve_arc(const Vector3& begin, const Vector3& end, const Vector3& centre,
                            const Vector3& normal);

}  // namespace meridian::cl
