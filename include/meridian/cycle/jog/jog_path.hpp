// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/winding.hpp"

/// The ways on which the tool is jogged. Frame: W. Units: mm, rad. RT: cycle.
/// Proof: tests/unit/cycle/jog_ends_test.cpp, tests/property/cycle/jog_tool_test.cpp.
namespace meridian {

/// z points from the tip to the shank. x is W's x made normal to it (W's y
/// where the tool points along x), y = z × x. Tilts are about x and y.
enum class ToolAxis : std::uint8_t { kX, kY, kZ, kTiltX, kTiltY };
inline constexpr int kToolAxisCount = 5;

/// One hold goes no farther: behind it the way is surveyed anew.
inline constexpr double kToolPath_mm = 100, kToolPath_rad = 0.5;

/// mm or rad; the inverse kinematics gives the joints of a way's middle back so far.
inline constexpr double kSameJoints = 1e-6;

/// A way of the tool as a function of s: tip + s·along, or, tilting, the axis
/// on a great circle.
struct ToolPath {
  Array3 tip{}, axis{0, 0, 1};
  Array3 direction{};  ///< unit: of the tip, or of the axis
  bool is_tilt = false;
  bool is_held =
      false;        ///< a tilt in the plane that the redundant joint stands in: that joint rests
  double free = 0;  ///< there
  std::uint8_t branch = 0;
  double tool_length_mm = 0;
};

template <class S>
[[nodiscard]] inline Pose<S> pose_on(const ToolPath& tool_path, const S& s) noexcept {
  Pose<S> pose;
  const SinCos<S> turn = sin_cos(tool_path.is_tilt ? s : S(0.0));
  for (std::size_t i = 0; i < 3; ++i) {
    pose.tip[i] =
        tool_path.is_tilt ? S(tool_path.tip[i]) : S(tool_path.tip[i] + s * tool_path.direction[i]);
    pose.axis[i] = tool_path.is_tilt
                       ? S(turn.cos * tool_path.axis[i] + turn.sin * tool_path.direction[i])
                       : S(tool_path.axis[i]);
  }
  return pose;
}

/// The joints at `s`, in the windings nearest to `reference`; not kOk: do not
/// use them.
template <class S>
[[nodiscard]] inline Solution<S> joints_on(const MachineModel& machine, const ToolPath& tool_path,
                                           const S& s, const JointVector& reference) noexcept {
  if (tool_path.is_held) {
    Solution<S> held =
        solve_held(machine, tool_path.tool_length_mm, pose_on(tool_path, s), S(tool_path.free));
    for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
      if (!machine.joints[i].is_rotary) continue;
      held.q[i] += kTurn_rad * whole_turns(value_of(held.q[i]), reference[i]);
    }
    return held;
  }
  Solution<S> at =
      solve(machine, tool_path.tool_length_mm, pose_on(tool_path, s), tool_path.branch, reference);
  // Where the axis stands still the pole holds nobody up.
  if (at.status == SolveStatus::kAtPole && !tool_path.is_tilt) at.status = SolveStatus::kOk;
  return at;
}

/// `v` made a unit vector. Eigen's own are no calls for the cycle: they are not noexcept.
[[nodiscard]] inline Array3 unit_of(const Array3& v) noexcept {
  const double per = 1 / std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] * per, v[1] * per, v[2] * per};
}

/// Whether `joints` are those of the way's middle, and the way lies in the plane that the free
/// joint stands in, wherever that is: such a tilt leads through the pole, and away from it, as from
/// anywhere.
[[nodiscard]] inline bool lies_in_plane(const MachineModel& machine, const ToolPath& held,
                                        const JointVector& joints) noexcept {
  constexpr double kAside_rad = 0.1, kSame = 1e-10;
  for (const double s : {-kAside_rad, 0.0, kAside_rad}) {
    const Solution<double> at = joints_on(machine, held, s, joints);
    if (at.status != SolveStatus::kOk) return false;
    const Pose<double> wanted = pose_on(held, s);
    const ToolPose is = forward(machine, held.tool_length_mm, at.q);
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (!(std::abs(is.axis[i] - wanted.axis[static_cast<std::size_t>(i)]) <= kSame)) return false;
    }
    for (std::size_t i = 0; s == 0 && i < joints.size(); ++i) {
      if (!(std::abs(at.q[i] - joints[i]) <= kSameJoints)) return false;
    }
  }
  return true;
}

/// Lays a way through where the tool is; false where no solution of the inverse
/// kinematics gives the joints back.
[[nodiscard]] inline bool find_tool_path(const MachineModel& machine, const JointVector& joints,
                                         double tool_length_mm, ToolAxis direction,
                                         ToolPath& tool_path) noexcept {
  const ToolPose pose = forward(machine, tool_length_mm, joints);
  const Array3 z = unit_of({pose.axis[0], pose.axis[1], pose.axis[2]});
  // W's x, or y, without its part along z.
  const std::size_t k = std::abs(z[0]) < 0.9 ? 0 : 1;
  Array3 x{-z[k] * z[0], -z[k] * z[1], -z[k] * z[2]};
  x[k] += 1;
  x = unit_of(x);
  const Array3 y{z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
  tool_path.tip = {pose.tip[0], pose.tip[1], pose.tip[2]};
  tool_path.axis = z;
  tool_path.is_tilt = direction >= ToolAxis::kTiltX;
  tool_path.tool_length_mm = tool_length_mm;
  switch (direction) {
    case ToolAxis::kX:
    case ToolAxis::kTiltY:  // about y, z turns towards x
      tool_path.direction = x;
      break;
    case ToolAxis::kY:
      tool_path.direction = y;
      break;
    case ToolAxis::kZ:
      tool_path.direction = z;
      break;
    case ToolAxis::kTiltX:  // about x, z turns towards -y
      tool_path.direction = {-y[0], -y[1], -y[2]};
      break;
  }
  const int free = redundant_joint(machine);
  tool_path.free = free >= 0 ? joints[static_cast<std::size_t>(free)] : 0;
  tool_path.is_held = tool_path.is_tilt && free >= 0;
  if (tool_path.is_held && lies_in_plane(machine, tool_path, joints)) return true;
  tool_path.is_held = false;
  for (int branch = 0; branch < branch_count(machine); ++branch) {
    tool_path.branch = static_cast<std::uint8_t>(branch);
    const Solution<double> at = joints_on(machine, tool_path, 0.0, joints);
    double apart = 0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      apart = std::max(apart, std::abs(at.q[i] - joints[i]));
    }
    if (at.status == SolveStatus::kOk && apart <= kSameJoints) return true;
  }
  return false;
}

}  // namespace meridian
