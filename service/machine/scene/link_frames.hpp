// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/scene/link_tree.hpp"

namespace meridian::scene {

/// A frame of the machine in that of the link that carries it. Units: mm.
struct LinkFrame {
  std::string parent, name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// The links of a machine as a tree of frames whose root is `machine`, the frame of the kinematics.
/// Every joint has the frame `NAME_link` of what it moves, which stands on the joint's axis and is
/// parallel to the root where every joint is at zero. `workpiece` is the frame of CL files, `tool`
/// has its origin at the tip and +z to the shank.
/// Proof: tests/unit/scene/link_frames_test.cpp.
class LinkFrames {
 public:
  explicit LinkFrames(const MachineModel& model);

  /// Where they are with the joints at `q` and that tool, parents before what they carry.
  [[nodiscard]] const std::vector<LinkFrame>& at(const JointVector& q, double tool_length_mm);

  /// Of the root, of links in the order of the head and of the table.
  [[nodiscard]] static const char* root() noexcept { return "machine"; }
  [[nodiscard]] const LinkTree& tree() const noexcept { return tree_; }
  /// Where the frames of the links stand in M with every joint at zero.
  [[nodiscard]] const std::vector<Vector3>& head_anchors_mm() const noexcept { return head_; }
  [[nodiscard]] const std::vector<Vector3>& table_anchors_mm() const noexcept { return table_; }
  /// The frame of link `i` of the head or of the table; the root's for -1.
  [[nodiscard]] std::string head_name(int i) const;
  [[nodiscard]] std::string table_name(int i) const;

 private:
  void add(const std::vector<Screw>& screws, const std::vector<Vector3>& anchors,
           const JointVector& q);

  LinkTree tree_;
  std::vector<std::string> joint_names_;
  Eigen::Isometry3d home_workpiece_ = Eigen::Isometry3d::Identity();
  std::vector<Vector3> head_, table_;
  std::vector<LinkFrame> frames_;
  std::size_t next_ = 0;  ///< frame that is worked out next
};

/// The rotation that takes +z to `axis`, the least one; to -z it turns about x.
[[nodiscard]] Eigen::Quaterniond from_z_to(const Vector3& axis) noexcept;

}  // namespace meridian::scene
