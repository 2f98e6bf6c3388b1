// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"

/// What a picture of a machine needs, worked out from its model alone. Units: mm, rad.
/// Frame: M, that of the kinematics, with every joint at zero.
namespace meridian::scene {

/// A joint as it moves what it carries: along, or about, `direction`.
struct Screw {
  int joint = 0;
  bool is_rotary = false;
  Vector3 direction = Vector3::UnitZ();
  Vector3 point_mm = Vector3::Zero();  ///< rotary: on its axis
};

/// Every family of machines in one form. In M
///
///     X_MT = exp(head 1) ... exp(head n) home_T      X_MW = exp(table 1) ... exp(table n) home_W
///
/// where home_T is at the gauge less the tool along `axis`, home_W the model's frame of the
/// workpiece, and the tip in W is forward() of the kinematics.
struct LinkTree {
  std::vector<Screw> head;   ///< from the base to the tool
  std::vector<Screw> table;  ///< from the base to the workpiece
  Vector3 gauge_mm = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();  ///< of the tool, to the shank
};

/// Source: docs/kinematics.md, chapters 2, 4 and 5. Proof: tests/unit/scene/link_frames_test.cpp,
/// tests/panel/scene_test.js.
[[nodiscard]] LinkTree link_tree(const MachineModel& model);

/// exp() of the screw: what its joint at `value` does to what it carries.
[[nodiscard]] Eigen::Isometry3d motion_of(const Screw& screw, double value);

}  // namespace meridian::scene
