// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"

/// What a simulated touch probe can touch. Units: mm, rad. Frame: that of the kinematics, which on
/// machines with a table moves with it. Proof: tests/unit/simulated_drives/probed_part_test.cpp.
namespace meridian::drives {

/// One body, or one hole.
struct ProbedShape {
  enum class Kind : std::uint8_t {
    kBox,     ///< from its origin by `size_mm` along its axes, either way
    kSphere,  ///< of `radius_mm` about its origin
    kBore     ///< a ring: a hole of `radius_mm` along its z, from its origin down by `depth_mm`
  };
  Kind kind = Kind::kBox;
  Vector3 origin_mm = Vector3::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< axes of the shape as its columns
  Vector3 size_mm = Vector3::Zero();
  double radius_mm = 0, depth_mm = 0;
};

/// The stylus, a ball at the end of the tool, and the part.
struct ProbedPart {
  double length_mm = 0;  ///< gauge line to the lowest point of the ball
  double ball_mm = 0;    ///< its radius
  std::vector<ProbedShape> shapes;
};

/// How far `point` is from the material of `shape`, mm; below 0: inside of it. A bore is a ring
/// with a wall of 10 mm.
[[nodiscard]] double distance_to(const ProbedShape& shape, const Vector3& point) noexcept;

/// A probe in the spindle of a machine, and the part in front of it.
class SimulatedProbe {
 public:
  SimulatedProbe(ProbedPart part, MachineModel machine);
  /// How far the ball is from the nearest shape, mm, with the drives at `drives`; at 0 and below
  /// the probe is in contact.
  [[nodiscard]] double distance(const JointVector& drives) const noexcept;

 private:
  ProbedPart part_;
  MachineModel machine_;
};

/// Reads the part of a TOML text, which messages call `name` (docs/operating.md). Throws
/// ConfigError.
[[nodiscard]] ProbedPart parse_probed_part(std::string_view text, const std::string& name);

}  // namespace meridian::drives
