// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/inspect/calibrate/touches.hpp"

/// Where the rotary axes of a machine lie, from touches of a sphere on its table. Units: mm, rad.
/// Frame: machine, at home. Proof: tests/unit/inspect/rotary_centres_test.cpp.
namespace meridian::inspect {

/// A point on a rotary axis.
struct RotaryCentre {
  std::string joint;
  Vector3 before_mm = Vector3::Zero(), after_mm = Vector3::Zero();
  /// Standard deviations of what was moved, along two directions across the axis; the larger one.
  double deviation_mm = 0;
  bool is_determined = true;  ///< false: the touches leave it open, so that it stays where it was
};

struct RotaryCentres {
  std::array<RotaryCentre, 2> centres;  ///< from the workpiece to the tool
  Vector3 sphere_mm = Vector3::Zero();  ///< its middle, in the frame of the kinematics
  double sphere_radius_mm = 0;
  double rms_mm = 0;         ///< of the touches from the sphere
  double largest_mm = 0;     ///< the farthest of them
  std::size_t farthest = 0;  ///< which, from 0
  [[nodiscard]] bool is_determined() const noexcept {
    return centres[0].is_determined && centres[1].is_determined;
  }
};

/// The axes for which all `touches` by a ball lie on one sphere, least squares over the points of
/// both axes across their directions, the sphere's middle, and its radius where
/// `sphere_radius_mm` does not say it. What the touches do not determine stays as the file has it.
/// The error: the machine is no chain, a touch is not by a ball, or there are too few.
[[nodiscard]] Expected<RotaryCentres, std::string> find_rotary_centres(
    const MachineModel& machine, const std::vector<Touch>& touches,
    std::optional<double> sphere_radius_mm);

/// The report for a person.
[[nodiscard]] std::string to_text(const RotaryCentres& found);

/// The text of a machine file with the points that were found, every other character as it was. The
/// error names the joint whose point does not stand there on a line of its own.
[[nodiscard]] Expected<std::string, std::string> with_centres(const std::string& machine_file,
                                                              const RotaryCentres& found);

}  // namespace meridian::inspect
