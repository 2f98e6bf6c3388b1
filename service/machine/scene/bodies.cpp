// SPDX-License-Identifier: Apache-2.0
#include "service/machine/scene/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace meridian::scene {
namespace {

/// What the sizes of bodies go by: a table that fits the travel, an arm that fits its reach.
[[nodiscard]] double size_of(const MachineModel& model, const LinkTree& tree) {
  double range = 0, reach = 0;
  for (const auto* screws : {&tree.head, &tree.table}) {
    for (const Screw& screw : *screws) {
      reach = std::max(reach, screw.point_mm.norm());
      if (screw.is_rotary) continue;
      const JointLimits& limits = model.joints[static_cast<std::size_t>(screw.joint)].limits;
      const double travel = limits.travel_max - limits.travel_min;
      range = range > 0 ? std::min(range, travel) : travel;
    }
  }
  return range > 0 ? std::clamp(0.22 * range, 60.0, 320.0) : std::max(60.0, 0.14 * reach);
}

class Builder {
 public:
  explicit Builder(double size_mm) : size_(size_mm) {}

  /// A body between two points of M that hangs in the frame that stands at `anchor`.
  void beam(const std::string& frame, const Vector3& anchor, const Vector3& from, const Vector3& to,
            double width, Part part) {
    const Vector3 along = to - from;
    if (along.norm() < 0.05 * size_) return;
    bodies.push_back({frame, Shape::kCylinder, part, (from + to) / 2 - anchor, along.normalized(),
                      along.norm(), width * size_});
  }
  /// The joint itself, in its own frame.
  void joint(const std::string& frame, const Screw& screw) {
    bodies.push_back({frame, screw.is_rotary ? Shape::kCylinder : Shape::kBox, Part::kJoint,
                      Vector3::Zero(), screw.direction, 0.6 * size_, 0.5 * size_});
  }

  std::vector<Body> bodies;

 private:
  double size_;
};

}  // namespace

std::vector<Body> bodies_of(const MachineModel& model, const LinkFrames& frames,
                            double tool_length_mm) {
  const LinkTree& tree = frames.tree();
  const double size = size_of(model, tree);
  Builder builder(size);
  const std::vector<Vector3>& head = frames.head_anchors_mm();
  const int last = static_cast<int>(head.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Vector3& outer = i < last ? head[at + 1] : tree.gauge_mm;
    builder.joint(frames.head_name(i), tree.head[at]);
    builder.beam(frames.head_name(i), head[at], head[at], outer, 0.35, Part::kMoving);
  }
  if (last >= 0 && tree.head[0].is_rotary) {
    builder.beam(LinkFrames::root(), Vector3::Zero(), Vector3::Zero(), head[0], 0.6, Part::kBase);
  }
  const std::vector<Vector3>& table = frames.table_anchors_mm();
  for (std::size_t i = 0; i < table.size(); ++i) {
    builder.joint(frames.table_name(static_cast<int>(i)), tree.table[i]);
    if (i + 1 == table.size()) continue;
    builder.beam(frames.table_name(static_cast<int>(i)), table[i], table[i], table[i + 1], 0.35,
                 Part::kMoving);
  }
  // The plate below the workpiece, spindle and tool.
  const int plate = static_cast<int>(table.size()) - 1;
  const Vector3 under = plate >= 0 ? table.back() : Vector3::Zero();
  const Vector3 normal = model.X_MW.rotation.col(2);
  builder.bodies.push_back({frames.table_name(plate), Shape::kCylinder, Part::kTable,
                            model.X_MW.origin_mm - 0.07 * size * normal - under, normal,
                            0.14 * size, 2.4 * size});
  const double spindle = 0.6 * size, tool = std::max(tool_length_mm, 1.0);
  builder.bodies.push_back({"tool", Shape::kCylinder, Part::kMoving,
                            Vector3(0, 0, tool_length_mm + spindle / 2), Vector3::UnitZ(), spindle,
                            0.4 * size});
  builder.bodies.push_back({"tool", Shape::kCylinder, Part::kTool, Vector3(0, 0, tool / 2),
                            Vector3::UnitZ(), tool, std::max(0.08 * tool, 1.0)});
  return builder.bodies;
}

}  // namespace meridian::scene
