// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/singular/pole/pole_probes.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "service/core/planner/singular/pole/pole_walls.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

/// Paths beside the pole, and the walls along them.
namespace meridian::test::pole_walls {

inline constexpr double kTolerance_rad = 0.00175;
inline constexpr double kUsed = 0.995;  // of the tolerance
inline constexpr double kTool_mm = 100;

/// A path past the pole at u = 60, `beside` off it, and its walls from 40 to 80. The programmed
/// axis is `off` beside the smoothed one.
struct Walled {
  explicit Walled(double beside, const Lean& off = {0, 0})
      : Walled(
            120,
            [beside](double u) {
              return Lean{0.004 * (u - 60), beside};
            },
            40, 80, off) {}
  /// The same where the axis leans as lean(u), along `count` mm of u.
  template <class LeanAt>
  Walled(int count, const LeanAt& lean, double begin, double end, const Lean& off = {0, 0}) {
    probes.begin(true);
    for (const BandSpan& span : leaning_path(count, lean)) probes.push(span);
    const auto programmed_at = [&](double u) {
      const Lean at = lean(u);
      return axis_of({at.x + off.x, at.y + off.y});
    };
    programmed.begin(programmed_at(0));
    for (int n = 1; n <= count; ++n) programmed.add(n, programmed_at(n));
    pass.begin = begin;
    pass.end = end;
    pass.joints = joints_at(begin, 0);
  }
  [[nodiscard]] ToolPose pose_at(double u) const { return pose_of<double>(probes.span_at(u), u); }
  [[nodiscard]] JointVector joints_at(double u, int branch) const {
    return solve(model, kTool_mm, pose_at(u), branch, {}).q;
  }
  [[nodiscard]] bool look() { return walls.look(task, pass); }
  /// The angle between the programmed axis and the one that the redundant joint gives.
  [[nodiscard]] double off_at(double u, double free) const {
    const auto at = solve_held(model, kTool_mm, pose_at(u), free);
    const Vector3 axis = forward(model, kTool_mm, at.q).axis;
    return angle_between(programmed.at(u)->axis, axis);
  }

  MachineModel model = bench_machine();
  PoleProbes probes{model};
  ProgrammedAxis programmed;
  PolePass pass;
  PoleTask task{model, probes, programmed, kTool_mm, kTolerance_rad};
  PoleWalls walls;
};

}  // namespace meridian::test::pole_walls
