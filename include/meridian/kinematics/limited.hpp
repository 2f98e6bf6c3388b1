// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/stage.hpp"

/// Everything of a machine that has limits: its joints in machine order, then the drives of its
/// actuator stage. Who keeps limits goes through this list, and a stage is kept like joints are; a
/// machine without one has its joints and nothing else. Nothing here allocates or throws.
/// Units: mm, rad.
namespace meridian {

/// A stage needs a linear joint, and machines that have one have five joints.
inline constexpr int kMaxLimited = 5 + kStageDrives;
static_assert(kMaxLimited >= kMaxJoints);

/// One value for everything that has limits; places beyond limited_count() are zero.
template <class S>
using Limited = std::array<S, kMaxLimited>;
using LimitedVector = Limited<double>;

[[nodiscard]] inline bool has_stage(const MachineModel& model) noexcept {
  return model.stage.kind != StageKind::kIdentity;
}

/// How many quantities have limits.
[[nodiscard]] inline int limited_count(const MachineModel& model) noexcept {
  return has_stage(model) ? model.joint_count + kStageDrives : model.joint_count;
}

/// Name, kind and limits of quantity `i`, 0 to limited_count() - 1.
[[nodiscard]] inline const JointSpec& limited_spec(const MachineModel& model, int i) noexcept {
  return i < model.joint_count
             ? model.joints[static_cast<std::size_t>(i)]
             : model.stage_drives[static_cast<std::size_t>(i - model.joint_count)];
}

/// Returns what has limits where the joints are `q`; with jets, its derivatives too. Where the
/// stage cannot follow the joints, the drives are not finite. RT: cycle.
/// Proof: tests/unit/kinematics/stage_test.cpp.
template <class S>
[[nodiscard]] inline Limited<S> limited_of(const MachineModel& model, const Joints<S>& q) noexcept {
  Limited<S> out{};
  for (std::size_t i = 0; i < q.size(); ++i) out[i] = q[i];
  if (has_stage(model)) {
    const Joints<S> u = stage::drives_of(model.stage, q);
    const auto first = static_cast<std::size_t>(model.joint_count);
    out[first] = u[static_cast<std::size_t>(model.stage.linear_joint)];
    out[first + 1] = u[static_cast<std::size_t>(model.stage.rotary_joint)];
  }
  return out;
}

/// The same where the drive coordinates `u` of the joints are known already.
[[nodiscard]] inline LimitedVector limited_of(const MachineModel& model, const JointVector& q,
                                              const JointVector& u) noexcept {
  LimitedVector out{};
  for (std::size_t i = 0; i < q.size(); ++i) out[i] = q[i];
  if (has_stage(model)) {
    const auto first = static_cast<std::size_t>(model.joint_count);
    out[first] = u[static_cast<std::size_t>(model.stage.linear_joint)];
    out[first + 1] = u[static_cast<std::size_t>(model.stage.rotary_joint)];
  }
  return out;
}

/// Returns quantity `i` where the joints are `q`.
[[nodiscard]] inline double limited_value(const MachineModel& model, const JointVector& q,
                                          int i) noexcept {
  return limited_of(model, q)[static_cast<std::size_t>(i)];
}

/// Drive coordinates in drive order: as the joints, a stage's sliders in place of the two
/// joints that it carries. RT: cycle.
template <class S>
[[nodiscard]] inline Joints<S> drives_of(const MachineModel& model, const Joints<S>& q) noexcept {
  return stage::drives_of(model.stage, q);
}

/// Drive coordinates of limited_of() values. RT: cycle.
[[nodiscard]] inline JointVector drives_at(const MachineModel& model,
                                           const LimitedVector& all) noexcept {
  JointVector u{};
  for (int i = 0; i < model.joint_count; ++i) {
    u[static_cast<std::size_t>(i)] = all[static_cast<std::size_t>(i)];
  }
  if (!has_stage(model)) return u;
  const auto first = static_cast<std::size_t>(model.joint_count);
  u[static_cast<std::size_t>(model.stage.linear_joint)] = all[first];
  u[static_cast<std::size_t>(model.stage.rotary_joint)] = all[first + 1];
  return u;
}

/// The joints of drive coordinates `u`; not finite where there are none. RT: cycle.
[[nodiscard]] inline JointVector joints_of(const MachineModel& model,
                                           const JointVector& u) noexcept {
  return stage::joints_of(model.stage, u);
}

/// Returns the velocity of the joints `q` whose drives move with `u_velocity`.
[[nodiscard]] inline JointVector joint_velocity_of(const MachineModel& model, const JointVector& q,
                                                   const JointVector& u_velocity) noexcept {
  return stage::joint_velocity_of(model.stage, q, u_velocity);
}

/// Name, kind and limits of drive `i` in drive order.
[[nodiscard]] inline const JointSpec& drive_spec(const MachineModel& model, int i) noexcept {
  if (has_stage(model) && i == model.stage.linear_joint) return model.stage_drives[0];
  if (has_stage(model) && i == model.stage.rotary_joint) return model.stage_drives[1];
  return model.joints[static_cast<std::size_t>(i)];
}

}  // namespace meridian
