// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/inspect/picture/skeleton.hpp"

namespace meridian::inspect {

/// What one joint alone does to the tool, from the point where the joints are tried. Units: mm,
/// rad. Frame: W.
struct JointTrial {
  int joint = 0;
  double step = 0;       ///< mm or rad; backwards where travel does not allow it forwards
  Vector3 tip_move;      ///< of the tip in the workpiece
  double axis_turn = 0;  ///< of the tool axis
  Vector3 axis_towards;  ///< unit, where the axis leans; zero where it does not turn
};

/// Everything that `meridian machine` reports about a machine. Units: mm, rad. Frame: W.
struct Inspection {
  Skeleton skeleton;
  JointVector home{};
  ToolPose home_pose;
  JointVector trial_joints{};  ///< home, with the tilt off a pole that home would be on
  ToolPose trial_pose;
  std::vector<JointTrial> trials;
  double home_measure = 0;
  bool is_origin_in_reach = false;  ///< of W, with the tool along z
  double all_tilt = 0;              ///< every tool axis so far from z is in reach at W's origin
  double some_tilt = 0;  ///< farthest axis from z that is in reach there, of those looked at
  std::array<std::array<double, 2>, 3> straight{};  ///< from W's origin, x, y, z, tool along z
  double round_trip_mm = 0;  ///< largest error of joints to pose and back, over draws in travel
  double round_trip_axis = 0;
  std::vector<std::string> warnings;  ///< what its author should look at
  std::vector<std::string> measured;  ///< what is a little off and, the file says, measured
};

/// Whether some branch and winding puts the tool there inside every travel. Frame: W.
[[nodiscard]] bool is_in_reach(const MachineModel& model, const ToolPose& pose);

/// Where the joints are tried: home, and off the pole if home is on it.
[[nodiscard]] JointVector trial_joints(const MachineModel& model);

/// Computes all of it. Takes some tenths of a second. Proof:
/// tests/unit/inspect/inspect_test.cpp.
[[nodiscard]] Inspection inspect(const MachineModel& model);

/// What looks like a slip of the file's author: axes a little off the usual directions, linear
/// joints that run nearly the same way, limits whose units can hardly be meant.
/// Where the file says that its numbers are measured, what is a little off is no slip.
struct Slips {
  std::vector<std::string> warnings, measured;
};
[[nodiscard]] Slips find_slips(const MachineModel& model, const Skeleton& skeleton);

/// Report: chain, home, trial of every joint, poles, reach, limits, warnings.
[[nodiscard]] std::string to_text(const Inspection& inspection, const MachineModel& model);

}  // namespace meridian::inspect
