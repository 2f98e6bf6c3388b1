// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/inspect/program_poses.hpp"

/// Where on a machine a program fits. Units: mm, rad. Proof: tests/unit/inspect/placing_test.cpp.
namespace meridian::inspect {

/// Where the workpiece may lie: its origin, and its turn about z beside that of the model.
struct PlacingBox {
  std::array<double, 3> low_mm{}, high_mm{};
  bool may_turn = false;
};

/// How a program fits at one frame. A branch of the kinematics is kept from begin to end, joints
/// follow from pose to pose, windings included.
struct Fit {
  /// The smallest distance of a joint or drive to an end of its travel, as a share of half that
  /// travel: 1 where all stand in the middle, below 0 where one is beyond, -1 and less where a pose
  /// is out of reach.
  double margin = -2;
  /// The margin and a hundredth of the mean of all: what a search makes large, for a joint that the
  /// frame cannot help must not leave the others anywhere.
  double score = -2;
  int joint = -1;          ///< that has it, by its place in limited.hpp; -1: out of reach
  std::uint32_t line = 0;  ///< where it is there
  int branch = 0;
  LimitedVector least{}, most{};  ///< every joint and drive over the program
};

struct Placing {
  std::array<double, 3> origin_mm{};
  double turn_rad = 0;  ///< about z
  Fit fit;
  int frames = 0;  ///< that were tried
};

/// How `poses` fit with the workpiece of `model` where it is.
[[nodiscard]] Fit fit_of(const MachineModel& model, const std::vector<ProgramPose>& poses);

/// A box that holds every frame in which the middle of the program is where some joints inside
/// travel put the tip.
[[nodiscard]] PlacingBox widest_box(const MachineModel& model,
                                    const std::vector<ProgramPose>& poses);

/// The frame in `box` with the largest margin that a search finds: frames spread evenly, then steps
/// from the best of them that halve. The same call gives the same frame.
[[nodiscard]] Placing find_placing(const MachineModel& model, const std::vector<ProgramPose>& poses,
                                   const PlacingBox& box);

/// `model` with its workpiece at `origin_mm`, turned about z by `turn_rad` beside what it was.
[[nodiscard]] MachineModel placed(MachineModel model, const std::array<double, 3>& origin_mm,
                                  double turn_rad);

/// The frame as --frame takes it: x,y,z,a,b,c in mm and deg.
[[nodiscard]] std::string frame_text(const MachineModel& placed_model);

/// The report for a person.
[[nodiscard]] std::string to_text(const Placing& placing, const MachineModel& model);

}  // namespace meridian::inspect
