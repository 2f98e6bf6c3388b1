// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meridian/units.hpp"
#include "service/machine/inspect/calibrate/unit_slips.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

constexpr double kExact = 1e-6;  // rad and mm: what rounding of a file makes
constexpr double kNearMiss_deg = 2;
constexpr double kNearMiss_mm = 0.5;
constexpr double kMinVolume = 0.5;  // of three unit vectors

/// Angle to the nearest direction whose coordinates are all 0 or of one size: axes, 45 degrees
/// between two, the diagonal of a cube.
double off_usual(const Vector3& direction) {
  double min = std::numbers::pi;
  for (int code = 1; code < 27; ++code) {
    const Vector3 usual{code % 3 - 1.0, code / 3 % 3 - 1.0, code / 9 - 1.0};
    if (usual.squaredNorm() == 0) continue;
    const Vector3 unit = usual.normalized();
    min = std::min(min, std::atan2(unit.cross(direction).norm(), unit.dot(direction)));
  }
  return min;
}

const char* name_of(const MachineModel& model, const SkeletonJoint& joint) {
  return model.joints[static_cast<std::size_t>(joint.joint)].name.c_str();
}

/// Something that is a little off what people build: a fact where the file is of measured numbers.
void add_little_off(const MachineModel& model, const std::string& what, Slips& out) {
  if (model.is_measured) {
    out.measured.push_back(what);
  } else {
    out.warnings.push_back(what + ": a slip? If it is measured, say measured = true");
  }
}

void look_at_directions(const MachineModel& model, const Skeleton& skeleton, Slips& out) {
  std::vector<Vector3> linear;
  for (const SkeletonJoint& joint : skeleton.joints) {
    if (!joint.is_rotary) linear.push_back(joint.direction);
    if (model.family != MachineFamily::kChain) continue;
    const double off = off_usual(joint.direction);
    if (off > kExact && off < units::rad_from_deg(kNearMiss_deg)) {
      add_little_off(model,
                     printed("%s runs %.4g deg beside a usual direction", name_of(model, joint),
                             units::deg_from_rad(off)),
                     out);
    }
  }
  if (linear.size() != 3) return;
  const double volume = std::abs(linear[0].dot(linear[1].cross(linear[2])));
  if (volume < kMinVolume) {
    out.warnings.push_back(
        printed("the linear joints run nearly in one plane (volume %.3g of 1): small ways "
                "of the tip take long ways of the joints",
                volume));
  }
}

/// Rotary axes that miss each other by less than anybody builds.
void look_at_pivots(const MachineModel& model, const Skeleton& skeleton, Slips& out) {
  if (model.family != MachineFamily::kChain) return;
  const ChainKinematics& k = model.chain;
  const Vector3 normal = k.a.axis.cross(k.b.axis).normalized();
  const double apart = std::abs(normal.dot(k.b.point_mm - k.a.point_mm));
  if (apart > kExact && apart < kNearMiss_mm) {
    add_little_off(model, printed("the rotary axes miss each other by %.4g mm", apart), out);
  }
  for (const SkeletonJoint& joint : skeleton.joints) {
    const JointSpec& spec = model.joints[static_cast<std::size_t>(joint.joint)];
    if (!is_inside_travel(spec, 0, 0)) {
      out.warnings.push_back(
          spec.name +
          " cannot stand at zero, where the machine is described: does the file mean "
          "another home?");
    }
  }
}

}  // namespace

Slips find_slips(const MachineModel& model, const Skeleton& skeleton) {
  Slips out;
  look_at_directions(model, skeleton, out);
  look_at_pivots(model, skeleton, out);
  find_unit_slips(model, out.warnings);
  return out;
}

}  // namespace meridian::inspect
