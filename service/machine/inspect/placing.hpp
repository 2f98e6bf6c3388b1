// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/inspect/calibrate/fit.hpp"
#include "service/machine/inspect/program_poses.hpp"

/// Where on a machine a program fits. Units: mm, rad. Proof: tests/unit/inspect/placing_test.cpp.
namespace meridian::inspect {

/// Where the workpiece may lie: its origin, and its turn about z beside that of the model.
struct PlacingBox {
  std::array<double, 3> low_mm{}, high_mm{};
  bool may_turn = false;
};

/// What a search makes large.
enum class PlacingAim {
  kMargin,  ///< the distance to every end of travel
  kTime     ///< the speed: the estimated time gets small, with kTimeMargin left
};

/// Share of half the travel that a frame leaves that is chosen for its time.
inline constexpr double kTimeMargin = 0.02;

struct Placing {
  std::array<double, 3> origin_mm{};
  double turn_rad = 0;  ///< about z
  Fit fit;
  int frames = 0;  ///< that were tried
};

/// A box that holds every frame in which the middle of the program is where some joints inside
/// travel put the tip.
[[nodiscard]] PlacingBox widest_box(const MachineModel& model,
                                    const std::vector<ProgramPose>& poses);

/// The best frame in `box` for `aim` that a search finds: frames spread evenly, then steps from the
/// best of them that halve. The same call gives the same frame.
[[nodiscard]] Placing find_placing(const MachineModel& model, const std::vector<ProgramPose>& poses,
                                   const PlacingBox& box, PlacingAim aim = PlacingAim::kMargin);

/// `model` with its workpiece at `origin_mm`, turned about z by `turn_rad` beside what it was.
[[nodiscard]] MachineModel placed(MachineModel model, const std::array<double, 3>& origin_mm,
                                  double turn_rad);

/// The frame as --frame takes it: x,y,z,a,b,c in mm and deg.
[[nodiscard]] std::string frame_text(const MachineModel& placed_model);

/// The report for a person; `poses` say what all is in the way where nothing fits.
[[nodiscard]] std::string to_text(const Placing& placing, const MachineModel& model,
                                  const std::vector<ProgramPose>& poses);

}  // namespace meridian::inspect
