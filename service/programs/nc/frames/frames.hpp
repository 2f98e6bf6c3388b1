// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "service/programs/cl/interpreter/frame.hpp"

namespace meridian::nc {

/// Whether the tool stands across a tilted plane.
enum class Tilt : std::uint8_t {
  kNone,
  kDefined,  ///< G68.2 without G53.1, PLANE .. STAY: the rotary axes have not followed yet
  kTurned    ///< the control has turned them: the tool axis is z of the plane
};

/// G68.2 P2 and P3 define a plane in several blocks, Q1 and on: what is defined so far.
struct PlaneInParts {
  int form = 0;                                                ///< of P; 0: none has begun
  int last = 0;                                                ///< Q of the last block
  Vector3 origin = Vector3::Zero(), second = Vector3::Zero();  ///< the two points of P2
  Vector3 x_axis = Vector3::UnitX();                           ///< of P3
};

/// What lies between the points of a program and its zero. Lengths in the unit of the program.
struct ProgramFrames {
  cl::Frame shift;  ///< TRANS, ROT and their kin, datum shift, G52
  cl::Frame plane;  ///< G68.2, CYCLE800, PLANE SPATIAL
  cl::Frame now;    ///< both together: program = now * written
  Tilt tilt = Tilt::kNone;
  PlaneInParts parts;
  Vector3 zero_mm = Vector3::Zero();  ///< of the work offset, from the zero of the station's frame
};

/// A turn by `deg` about x, y or z (0, 1, 2).
[[nodiscard]] cl::Frame turned_about(std::size_t axis, double deg);
[[nodiscard]] cl::Frame moved_by(const Vector3& offset);

/// One turn after the other, each about an axis as the ones before have left it.
struct Turn {
  std::size_t axis;
  double deg;
};
[[nodiscard]] cl::Frame turned(std::initializer_list<Turn> turns);

/// The frame of an origin, a direction along its x, and its z; lengths do not matter.
[[nodiscard]] cl::Frame frame_along(const Vector3& origin, const Vector3& x, const Vector3& z);
/// Whether two directions stand square on each other, within 0.06 degrees.
[[nodiscard]] bool are_square(const Vector3& a, const Vector3& b);

}  // namespace meridian::nc
