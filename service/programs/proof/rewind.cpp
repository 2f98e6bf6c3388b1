// SPDX-License-Identifier: Apache-2.0
#include "service/programs/proof/rewind.hpp"

#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/winding.hpp"

namespace meridian::proof {
namespace {

constexpr double kPlace_mm = 1e-3;  // words are rounded to 0.1 um and 0.1 urad
constexpr double kAngle_rad = 1e-6;

/// Where a step stands as seen from where the rewind began, with the redundant joint turned back.
struct Lift {
  double up_mm = 0;  ///< along the tool axis
  double turn_rad = 0;
  bool is_on_axis = false;
};

class RewindFinder {
 public:
  RewindFinder(const ProgramStep& rest, const MachineModel& model)
      : model_(model),
        free_(redundant_joint(model)),
        joints_(joints_of(model, rest.drives)),
        pose_(forward(model, model.tool_length_mm, joints_)) {}

  [[nodiscard]] Lift lift_of(const ProgramStep& step) const {
    JointVector joints = joints_of(model_, step.drives);
    const double turn = joints[free_] - joints_[free_];
    joints[free_] = joints_[free_];
    const ToolPose at = forward(model_, model_.tool_length_mm, joints);
    const Vector3 off = at.tip - pose_.tip;
    const double up = off.dot(pose_.axis);
    const bool is_on_axis = (off - up * pose_.axis).norm() <= kPlace_mm &&
                            angle_between(at.axis, pose_.axis) <= kAngle_rad && up >= -kPlace_mm;
    return {up, turn, is_on_axis};
  }

 private:
  const MachineModel& model_;
  int free_;
  JointVector joints_;
  ToolPose pose_;
};

bool is_whole_turn(double turn) {
  return std::abs(turn) > 1 && std::abs(std::remainder(turn, kTurn_rad)) <= kAngle_rad;
}

}  // namespace

std::optional<std::size_t> find_rewind(const ProgramStep& rest, std::span<const ProgramStep> steps,
                                       const MachineModel& model, double clear_mm) {
  if (redundant_joint(model) < 0 || steps.empty() ||
      steps.front().kind != ProgramStep::Kind::kRapid || !rest.is_placed || rest.tool_pose) {
    return std::nullopt;
  }
  const RewindFinder finder(rest, model);
  Lift before;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const ProgramStep& step = steps[n];
    const bool moves =
        step.kind == ProgramStep::Kind::kRapid || step.kind == ProgramStep::Kind::kCut;
    if (!moves || !step.is_placed || step.tool_pose) return std::nullopt;
    const Lift now = finder.lift_of(step);
    const bool turns = std::abs(now.turn_rad - before.turn_rad) > kAngle_rad;
    const bool is_clear =
        before.up_mm >= clear_mm && std::abs(now.up_mm - before.up_mm) < kPlace_mm;
    if (!now.is_on_axis || (turns && !is_clear)) return std::nullopt;
    if (now.up_mm <= kPlace_mm) {
      return is_whole_turn(now.turn_rad) ? std::optional(n) : std::nullopt;
    }
    before = now;
  }
  return std::nullopt;
}

}  // namespace meridian::proof
