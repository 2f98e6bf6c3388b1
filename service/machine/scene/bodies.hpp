// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/scene/link_frames.hpp"

namespace meridian::scene {

enum class Shape { kBox, kCylinder };
/// Who it belongs to, for its colour.
enum class Part { kBase, kMoving, kJoint, kTable, kTool };

/// A body that stands in the frame of a link. Units: mm.
struct Body {
  std::string frame;
  Shape shape = Shape::kBox;
  Part part = Part::kMoving;
  Vector3 centre_mm = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();  ///< of its length
  double length_mm = 0, width_mm = 0;
};

/// Simple bodies that show how a machine is built: beams from joint to joint, a cylinder about
/// every rotary joint, a box on every linear one, table, spindle and tool. No machine looks so.
/// Proof: tests/unit/scene/bodies_test.cpp.
[[nodiscard]] std::vector<Body> bodies_of(const MachineModel& model, const LinkFrames& frames,
                                          double tool_length_mm);

}  // namespace meridian::scene
