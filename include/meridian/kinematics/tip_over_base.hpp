// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/chain.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/lai_chain.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/robot.hpp"
#include "meridian/kinematics/tip_box.hpp"

/// Where the tool tip is over the base of the machine, whatever the table does: frame M, that of
/// the kinematics with every joint at zero. Nothing here allocates or throws. Units: mm, rad.
/// RT: cycle. Source: docs/kinematics.md, chapters 2, 4 and 5.
/// Proof: tests/unit/kinematics/tip_box_test.cpp, tests/unit/scene/link_frames_test.cpp.
namespace meridian {

namespace detail {

template <class S>
[[nodiscard]] inline std::array<S, 3> tip_of_lai(const LaiKinematics& lai, double tool_length_mm,
                                                 const Joints<S>& q) noexcept {
  const double length = lai.pivot_mm + tool_length_mm;
  const SinCos<S> tilt = sin_cos(q[lai::kTheta2]);
  return {S(q[lai::kB3] - length * tilt.sin), S(-lai.e_mm),
          S(lai.h_mm - q[lai::kB4] - length * tilt.cos)};
}

/// The joints on the side of the head, from the tool to the base.
template <class S>
[[nodiscard]] inline std::array<S, 3> tip_of_chain(const ChainKinematics& k, double tool_length_mm,
                                                   const Joints<S>& q) noexcept {
  Vec3<S> p;
  for (int i = 0; i < 3; ++i) p[i] = S(k.gauge_mm[i] - tool_length_mm * k.home_axis[i]);
  for (std::size_t n = k.chain.size(); n-- > 0 && !k.chain[n].is_table_side;) {
    const ChainJoint& joint = k.chain[n];
    const S& at = q[static_cast<std::size_t>(joint.joint)];
    if (joint.is_rotary) {
      for (int i = 0; i < 3; ++i) p[i] -= joint.point_mm[i];
      p = chain::turn<S>(joint.direction, sin_cos(at), p);
      for (int i = 0; i < 3; ++i) p[i] += joint.point_mm[i];
    } else {
      for (int i = 0; i < 3; ++i) p[i] += joint.direction[i] * at;
    }
  }
  return {p[0], p[1], p[2]};
}

}  // namespace detail

/// The tip in M of the joints `q`.
template <class S>
[[nodiscard]] inline std::array<S, 3> tip_over_base(const MachineModel& model,
                                                    double tool_length_mm,
                                                    const Joints<S>& q) noexcept {
  switch (model.family) {
    case MachineFamily::kChain:
      return detail::tip_of_chain(model.chain, tool_length_mm, q);
    case MachineFamily::kRobot: {
      const Vec3<S> tip = robot::forward(model.robot, tool_length_mm, q).tip;
      return {tip[0], tip[1], tip[2]};
    }
    case MachineFamily::kLai:
      break;
  }
  return detail::tip_of_lai(model.lai, tool_length_mm, q);
}

/// The joints that move the tip over the base, a bit for each: all but those of the table.
[[nodiscard]] inline std::uint32_t tip_joints(const MachineModel& model) noexcept {
  if (model.family == MachineFamily::kLai) {
    return 1U << lai::kB3 | 1U << lai::kB4 | 1U << lai::kTheta2;
  }
  std::uint32_t mask = (1U << static_cast<unsigned>(model.joint_count)) - 1;
  if (model.family == MachineFamily::kRobot) return mask;
  for (const ChainJoint& joint : model.chain.chain) {
    if (joint.is_table_side) mask &= ~(1U << static_cast<unsigned>(joint.joint));
  }
  return mask;
}

/// The first axis of M along which the tip leaves the tip box of `model` where the joints are `q`;
/// -1: none, or the machine has no such box.
[[nodiscard]] inline int tip_axis_outside(const MachineModel& model, double tool_length_mm,
                                          const JointVector& q) noexcept {
  if (!model.tip_box.is_set) return -1;
  return axis_outside(model.tip_box, tip_over_base(model, tool_length_mm, q));
}

/// The tip in M as `joint` moves from `q` and the others rest.
[[nodiscard]] inline std::array<TipCircle, 3> tip_circles(const MachineModel& model,
                                                          double tool_length_mm,
                                                          const JointVector& q,
                                                          int joint) noexcept {
  const auto n = static_cast<std::size_t>(joint);
  Joints<Jet<2>> moving;
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = Jet<2>(q[i]);
  moving[n] = Jet<2>::variable(q[n]);
  const std::array<Jet<2>, 3> tip = tip_over_base(model, tool_length_mm, moving);
  std::array<TipCircle, 3> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {value_of(tip[i]), tip[i].derivative(1), tip[i].derivative(2),
              model.joints[n].is_rotary};
  }
  return out;
}

}  // namespace meridian
