// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/inspect/program_poses.hpp"

/// How a program fits on a machine where its workpiece is. Units: mm, rad, s.
/// Proof: tests/unit/inspect/fit_test.cpp, placing_test.cpp.
namespace meridian::inspect {

/// How a program fits at one frame. A branch of the kinematics is kept from begin to end, joints
/// follow from pose to pose, windings included.
struct Fit {
  /// The smallest distance of a joint or drive to an end of its travel, as a share of half that
  /// travel: 1 where all stand in the middle, below 0 where one is beyond, a keep-out box is
  /// entered or the tip box left, -1 and less where a pose is out of reach.
  double margin = -2;
  /// The margin and a hundredth of the mean of all: what a search makes large, for a joint that the
  /// frame cannot help must not leave the others anywhere.
  double score = -2;
  int joint = -1;          ///< that has the margin, by its index in limited.hpp; -1: none
  int box = -1;            ///< the keep-out box that is entered; -1: none
  int tip_axis = -1;       ///< of the base, from 0, along which the tip leaves its box; -1: none
  std::uint32_t line = 0;  ///< where it is so
  int branch = 0;
  LimitedVector min{}, max{};  ///< every joint and drive over the program
};

/// How `poses` fit with the workpiece of `model` where it is.
[[nodiscard]] Fit fit_of(const MachineModel& model, const std::vector<ProgramPose>& poses);

/// What `poses` take on `branch` by their feeds and by the velocities and accelerations of joints
/// and drives, s. An estimate: corners that are smoothed, jerk and approaches are not in it.
[[nodiscard]] double estimated_time_s(const MachineModel& model,
                                      const std::vector<ProgramPose>& poses, int branch);

/// What is in the way of a program.
enum class Obstacle : std::uint8_t {
  kOutOfReach,  ///< no joints reach the pose
  kTravelMin,   ///< a joint is below its travel
  kTravelMax,   ///< a joint is above its travel
  kKeepOut,     ///< the joints are in a keep-out box, or pass one
  kTipBox       ///< the tip is outside of its box
};

/// One obstacle with the lines that it is in the way of.
struct FitFinding {
  Obstacle obstacle = Obstacle::kOutOfReach;
  int number = 0;       ///< of the joint in limited.hpp, of the box, or of the axis of the base
  double farthest = 0;  ///< by how much the joint is beyond its travel, in its unit, or the tip, mm
  std::uint32_t farthest_line = 0;
  std::uint32_t first_line = 0, last_line = 0;
  int lines = 0;  ///< how many of the program
};

/// Everything that is in the way of `poses` on `branch`, travel by joint, in a fixed order. Empty
/// where they fit.
[[nodiscard]] std::vector<FitFinding> findings_of(const MachineModel& model,
                                                  const std::vector<ProgramPose>& poses,
                                                  int branch);

}  // namespace meridian::inspect
