// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/inspect/program_poses.hpp"

namespace meridian::inspect {

/// The sliders of a hybrid machine and what leads from them to the table: rods, or slots. mm.
struct StagePosture {
  Vector3 centre = Vector3::Zero();            ///< of the table
  std::array<Vector3, kStageDrives> slider{};  ///< on its rail
  std::array<Vector3, kStageDrives> pin{};     ///< where its rod meets the table; slots: the slider
};

/// Where the parts of a machine are at one point of a program. Units: mm. Frame: that of the
/// kinematics.
struct MachinePosture {
  JointVector joints{};
  std::vector<Vector3> head;   ///< over the rotary joints to the gauge point
  std::vector<Vector3> table;  ///< over the rotary joints to the workpiece's origin
  Vector3 tip = Vector3::Zero();
  std::optional<StagePosture> stage;
  std::uint32_t line = 0;  ///< of the program
};

/// With the joints at `q` and that tool. Source of the stage: docs/kinematics.md, chapter 3. Proof:
/// tests/unit/inspect/machine_posture_test.cpp.
[[nodiscard]] MachinePosture posture_at(const MachineModel& model, const JointVector& q,
                                        double tool_length_mm);

/// Up to `count` poses of a program, begin and end among them, spaced as evenly along the path of
/// the gauge point as its poses allow. From pose to pose the joints go to the nearest solution
/// inside travel. The error names the line of a pose that has none. `count` is at least 2.
[[nodiscard]] Expected<std::vector<MachinePosture>, std::string> postures_along(
    const MachineModel& model, const std::vector<ProgramPose>& poses, int count);

}  // namespace meridian::inspect
