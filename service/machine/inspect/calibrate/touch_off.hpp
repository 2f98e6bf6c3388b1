// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/inspect/calibrate/touches.hpp"

/// The work frame of a workpiece that was touched, and the length of a tool that was.
/// Units: mm, rad. Frame: that of the kinematics. Proof: tests/unit/inspect/touch_off_test.cpp.
namespace meridian::inspect {

/// What was touched.
enum class TouchedShape : std::uint8_t {
  kFace,    ///< one touch: the origin along its normal
  kEdge,    ///< two touches of one side: its direction, and the origin along its normal
  kPlane,   ///< three touches of one side: the orientation, and the origin along its normal
  kCorner,  ///< three faces: one touch each for the origin alone; three, two and one for the
            ///< orientation too
  kBore     ///< three touches or more from inside: the centre across its axis
};

struct FoundFrame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3 origin_mm = Vector3::Zero();
  /// How far the touches are from the shape that was found, at most; 0 where they just determine
  /// it.
  double residual_mm = 0;
  std::string arithmetic;  ///< for a person, a line for each step
};

/// The frame that makes the touched faces lie at 0 of its axes, or the middle of the touched bore
/// its origin. What the touches do not determine stays as it is in `before`, whose axes say which
/// way a face looks: every touch goes toward one of them, up to a tilt of 30 degrees.
///
/// A tool that ends in a ball touches with the ball, a flat one with its flank, or with its tip
/// where it goes along its axis. The error says what is missing.
[[nodiscard]] Expected<FoundFrame, std::string> find_frame(TouchedShape shape,
                                                           const std::vector<Touch>& touches,
                                                           const MachineModel& before);

/// The length of a tool whose tip stands at `height_mm` above the origin of `machine`'s workpiece,
/// measured along its z, with joints at `joints`. The error: the tool lies across z.
[[nodiscard]] Expected<double, std::string> find_tool_length(const JointVector& joints,
                                                             double height_mm,
                                                             const MachineModel& machine);

/// The angles a, b, c in degrees of a rotation Rz(c) Ry(b) Rx(a).
[[nodiscard]] Array3 angles_deg(const Eigen::Matrix3d& rotation);

}  // namespace meridian::inspect
