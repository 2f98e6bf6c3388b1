// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "service/text/printed.hpp"

namespace meridian::stream {

/// A straight move of the tool tip, the tool axis on its great circle, or of all joints.
/// Frame: W.
struct StraightMove {
  ToolPose from, to;           ///< of the tip; of a move of the joints both are its end
  double feed_mm_per_min = 0;  ///< of the tip, or of the joints' path: 1 rad counts as 50 mm
  std::optional<JointVector> joints{};  ///< a move of all joints, at once, to these
};

/// The move as a CL program. Its first point is where the tool is, so that it needs no approach; a
/// move of the joints is the approach of its program (dds::kPolicyFirstJoints). ClReader gives both
/// points back bit for bit. Proof: tests/unit/simulate/move_forecast_test.cpp.
[[nodiscard]] inline std::string program_of(const StraightMove& move) {
  std::string text = "UNITS/MM\nMULTAX/ON\n";
  text::append(text, "FEDRAT/%.17g,MMPM\n", move.feed_mm_per_min);
  for (const ToolPose* pose : {&move.from, &move.to}) {
    const Vector3 &tip = pose->tip, &axis = pose->axis;
    text::append(text, "GOTO/%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", tip.x(), tip.y(), tip.z(),
                 axis.x(), axis.y(), axis.z());
  }
  return text + "FINI\n";
}

}  // namespace meridian::stream
