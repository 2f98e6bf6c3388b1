// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::inspect {

/// One branch of the inverse kinematics at a pose. Units: mm, rad.
struct PoseSolution {
  int branch = 0;
  JointVector q{};          ///< in the windings nearest to home that travel allows
  bool is_at_pole = false;  ///< a rotary joint is free there and stands at home
  double measure = 0;       ///< distance from singularity, see meridian::measure()
  int outside = -1;         ///< first joint or drive of the stage beyond travel; -1: none
  double beyond = 0;        ///< by how much it is
  int keep_out = -1;        ///< the keep-out box that it is inside of; -1: none
  int tip_outside = -1;  ///< axis of the base, from 0, along which the tip leaves its box; -1: none

  /// Whether a machine may stand there.
  [[nodiscard]] bool is_possible() const noexcept {
    return outside < 0 && keep_out < 0 && tip_outside < 0;
  }
};

/// Every branch that puts the tool at `pose`, each once, those beyond travel or at a box too. Empty
/// where the pose is out of reach. Frame: W. Proof: tests/unit/inspect/pose_solutions_test.cpp.
[[nodiscard]] std::vector<PoseSolution> solve_all(const MachineModel& model, const ToolPose& pose);

/// What given joints are, as one of solve_all(); their branch is not looked for.
[[nodiscard]] PoseSolution solution_of_joints(const MachineModel& model, const JointVector& q);

/// The whole turns by which rotary joint `joint` may leave `q` and stay inside travel.
struct Windings {
  int down = 0, up = 0;  ///< 0 for a linear or an endless joint
};
[[nodiscard]] Windings windings_at(const MachineModel& model, const JointVector& q, int joint);

/// What the pose asks for that the machine has not; only for poses without a solution.
[[nodiscard]] std::string why_unreachable(const MachineModel& model, const ToolPose& pose);

/// Report on the solutions of a pose: joints, drives, other windings, measure, what is beyond.
[[nodiscard]] std::string to_text(const std::vector<PoseSolution>& solutions,
                                  const MachineModel& model);
/// "; INSIDE THE KEEP-OUT BOX vice", "; TIP OUTSIDE ITS BOX along X"; empty where it is at no box.
[[nodiscard]] std::string boxes_text(const PoseSolution& solution, const MachineModel& model);
/// Report on tip and axis of given joints.
[[nodiscard]] std::string joints_text(const MachineModel& model, const JointVector& q);

/// The same two as JSON for programs; mm and deg.
[[nodiscard]] std::string to_json(const std::vector<PoseSolution>& solutions,
                                  const MachineModel& model, const ToolPose& pose);
[[nodiscard]] std::string joints_json(const MachineModel& model, const JointVector& q);

}  // namespace meridian::inspect
