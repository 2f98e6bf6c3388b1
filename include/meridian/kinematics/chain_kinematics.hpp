// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// One joint of a chain from the workpiece to the tool. Direction and point are those at home, in
/// the machine frame. A joint on the table side moves the workpiece.
struct ChainJoint {
  int joint = 0;  ///< its index in machine order
  bool is_rotary = false;
  bool is_table_side = false;
  Vector3 direction = Vector3::UnitZ();  ///< unit
  Vector3 point_mm = Vector3::Zero();    ///< on the axis; rotary joints only
};

/// Any machine with three linear and two rotary joints, in any order. Built once by
/// describe_chain(), which works out everything that does not depend on the pose.
/// Source: docs/kinematics.md, chapter 4.
struct ChainKinematics {
  static constexpr int kChainLength = 5;
  std::array<ChainJoint, kChainLength> chain{};  ///< workpiece to tool
  Vector3 home_axis = Vector3::UnitZ();          ///< k0: tool axis at home, tip to spindle
  Vector3 gauge_mm = Vector3::Zero();            ///< gauge point at home

  /// A rotary joint, a next to the workpiece or b next to the tool, and what is constant about it.
  struct Rotary {
    int joint = 0;
    double sign = 1;  ///< -1 on the table side
    Vector3 axis = Vector3::UnitZ();
    Vector3 point_mm = Vector3::Zero();
  };
  /// A linear joint. `group` is how many rotary joints stand between it and the workpiece.
  struct Linear {
    int joint = 0;
    int group = 0;
    Vector3 direction = Vector3::UnitX();  ///< turned round on the table side
  };
  Rotary a, b;
  std::array<Linear, 3> linear;
  int group = -1;             ///< of all three linear joints; -1: rotary joints stand between them
  bool slides_align = false;  ///< rotary joints can turn the linear ones nearly into one plane

  /// Frame of joint a: z along a, b in the half plane of z and +x; rows are its directions. The
  /// frame of joint b is this one turned about y, so that z runs along b.
  Eigen::Matrix3d frame_a = Eigen::Matrix3d::Identity();
  double psi_sin = 1, psi_cos = 0;         ///< angle between a and b
  Vector3 origin_a = Vector3::Zero();      ///< point of a, in the frame of a
  Vector3 a_to_b = Vector3::Zero();        ///< from there to the point of b, in the frame of a
  Vector3 b_to_gauge = Vector3::Zero();    ///< on to the gauge point at home, in the frame of b
  Vector3 home_axis_b = Vector3::UnitZ();  ///< k0 in the frame of b
  Eigen::Matrix3d slide_inverse =
      Eigen::Matrix3d::Identity();  ///< inverse of the linear directions in the frame of a, or b

  Vector3 tilt_sin, tilt_cos;      ///< of the axis about b, from k0: dot products, eq. 4.11
  double b0_sin = 0, b0_cos = 1;   ///< azimuth of k0 about b, from a, over sin ψ sin χ: eq. 4.8
  double m_sin = 0, m_cos = 1;     ///< m = (angle(b, k0) - angle(a, b)) / 2
  double p_sin = 0, p_cos = 1;     ///< p = (angle(b, k0) + angle(a, b)) / 2
  bool has_pole = false;           ///< K = a leaves joint a free
  bool has_opposite_pole = false;  ///< so does K = -a
  /// By so much the tool axis misses a where it comes nearest to it, χ - ψ: of a machine that was
  /// measured, and has a pole all the same. 0: they meet. Eq. 4.12.
  double pole_offset_rad = 0;
  Vector3 outwards = Vector3::UnitX();  ///< unit, across k0, away from b
};

/// Returns the chain with its constants worked out, or the reason why it cannot work: the five
/// joints are not three linear and two rotary ones, a direction is not unit, the rotary axes are
/// parallel, the tool axis is parallel to rotary axis b (it could not tilt), or the linear
/// directions at home do not span space, or the chain does not run from the workpiece to the tool.
/// At start-up only.
[[nodiscard]] Expected<ChainKinematics, std::string> describe_chain(
    const std::array<ChainJoint, ChainKinematics::kChainLength>& chain, const Vector3& home_axis,
    const Vector3& gauge_mm);

}  // namespace meridian
