// SPDX-License-Identifier: Apache-2.0
#include "service/machine/scene/link_frames.hpp"

#include <cmath>

namespace meridian::scene {
namespace {

/// Where the frames of a branch stand: a rotary joint's on its axis, next to what it carries; a
/// linear one's with what it carries. `from` is the outer end.
[[nodiscard]] std::vector<Vector3> anchors_of(const std::vector<Screw>& screws, Vector3 from) {
  std::vector<Vector3> out(screws.size());
  for (std::size_t n = screws.size(); n > 0; --n) {
    const Screw& screw = screws[n - 1];
    if (screw.is_rotary) {
      const Vector3 offset = from - screw.point_mm;
      from = screw.point_mm + offset.dot(screw.direction) * screw.direction;
    }
    out[n - 1] = from;
  }
  return out;
}

}  // namespace

Eigen::Quaterniond from_z_to(const Vector3& axis) noexcept {
  // Half of the angle between both: (1 + z · axis, z × axis), normalised.
  const double w = 1 + axis.z();
  const double length = std::hypot(axis.x(), axis.y(), w);
  if (w < 1e-12 || length == 0) return {0, 1, 0, 0};
  return {w / length, -axis.y() / length, axis.x() / length, 0};
}

LinkFrames::LinkFrames(const MachineModel& model)
    : tree_(link_tree(model)),
      head_(anchors_of(tree_.head, tree_.gauge_mm)),
      table_(anchors_of(tree_.table, model.X_MW.origin_mm)) {
  for (int i = 0; i < model.joint_count; ++i) {
    joint_names_.push_back(model.joints[static_cast<std::size_t>(i)].name);
  }
  home_workpiece_.linear() = model.X_MW.rotation;
  home_workpiece_.translation() = model.X_MW.origin_mm;
  std::string parent = root();
  for (const auto* screws : {&tree_.head, &tree_.table}) {
    parent = root();
    for (const Screw& screw : *screws) {
      const std::string name = joint_names_[static_cast<std::size_t>(screw.joint)] + "_link";
      frames_.push_back({parent, name, Eigen::Isometry3d::Identity()});
      parent = name;
    }
    frames_.push_back(
        {parent, screws == &tree_.head ? "tool" : "workpiece", Eigen::Isometry3d::Identity()});
  }
}

std::string LinkFrames::head_name(int i) const {
  if (i < 0) return root();
  return joint_names_[static_cast<std::size_t>(tree_.head[static_cast<std::size_t>(i)].joint)] +
         "_link";
}

std::string LinkFrames::table_name(int i) const {
  if (i < 0) return root();
  return joint_names_[static_cast<std::size_t>(tree_.table[static_cast<std::size_t>(i)].joint)] +
         "_link";
}

/// A link's frame is its anchor moved by its joint, seen from the anchor of the link before it.
void LinkFrames::add(const std::vector<Screw>& screws, const std::vector<Vector3>& anchors,
                     const JointVector& q) {
  Vector3 before = Vector3::Zero();
  for (std::size_t i = 0; i < screws.size(); ++i) {
    const Eigen::Isometry3d motion =
        motion_of(screws[i], q[static_cast<std::size_t>(screws[i].joint)]);
    Eigen::Isometry3d& pose = frames_[next_++].pose;
    pose.linear() = motion.linear();
    pose.translation() = motion * anchors[i] - before;
    before = anchors[i];
  }
}

const std::vector<LinkFrame>& LinkFrames::at(const JointVector& q, double tool_length_mm) {
  next_ = 0;
  add(tree_.head, head_, q);
  Eigen::Isometry3d& tool = frames_[next_++].pose;
  tool.linear() = from_z_to(tree_.axis).toRotationMatrix();
  tool.translation() = tree_.gauge_mm - tool_length_mm * tree_.axis;
  if (!head_.empty()) tool.translation() -= head_.back();
  add(tree_.table, table_, q);
  Eigen::Isometry3d& workpiece = frames_[next_++].pose;
  workpiece = home_workpiece_;
  if (!table_.empty()) workpiece.translation() -= table_.back();
  return frames_;
}

}  // namespace meridian::scene
