// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/probed_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"

namespace meridian::drives {
namespace {

constexpr double kBoreWall_mm = 10;

[[nodiscard]] double distance_to_box(const Vector3& p, const Vector3& size) noexcept {
  Vector3 outside = Vector3::Zero();
  double inside = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double from = std::min(0.0, size[i]), to = std::max(0.0, size[i]);
    const double beyond = std::max(from - p[i], p[i] - to);
    outside[i] = std::max(0.0, beyond);
    inside = std::max(inside, beyond);
  }
  return inside > 0 ? outside.norm() : inside;
}

}  // namespace

double distance_to(const ProbedShape& shape, const Vector3& point) noexcept {
  const Vector3 p = shape.rotation.transpose() * (point - shape.origin_mm);
  switch (shape.kind) {
    case ProbedShape::Kind::kBox:
      return distance_to_box(p, shape.size_mm);
    case ProbedShape::Kind::kSphere:
      return p.norm() - shape.radius_mm;
    case ProbedShape::Kind::kBore: {  // a ring: in its section, a box
      const Vector3 in_section(std::hypot(p.x(), p.y()) - shape.radius_mm, 0, p.z());
      return distance_to_box(in_section, {kBoreWall_mm, 0, -shape.depth_mm});
    }
  }
  return std::numeric_limits<double>::infinity();
}

SimulatedProbe::SimulatedProbe(ProbedPart part, MachineModel machine)
    : part_(std::move(part)), machine_(std::move(machine)) {
  machine_.X_MW.rotation = Eigen::Matrix3d::Identity();
  machine_.X_MW.origin_mm = Vector3::Zero();
}

double SimulatedProbe::distance(const JointVector& drives) const noexcept {
  const ToolPose pose = true_pose(machine_, part_.length_mm, joints_of(machine_, drives));
  const Vector3 centre = pose.tip + part_.ball_mm * pose.axis;
  double nearest = std::numeric_limits<double>::infinity();
  for (const ProbedShape& shape : part_.shapes) {
    nearest = std::min(nearest, distance_to(shape, centre));
  }
  return nearest - part_.ball_mm;
}

}  // namespace meridian::drives
