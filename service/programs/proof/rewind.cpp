// SPDX-License-Identifier: Apache-2.0
#include "service/programs/proof/rewind.hpp"

#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/winding.hpp"
#include "service/recording/record/check/towards_pole.hpp"

namespace meridian::proof {
namespace {

constexpr double kPlace_mm = 1e-3;  // words are rounded to 0.1 um and 0.1 urad
constexpr double kAngle_rad = 1e-6;

/// Where a step stands as seen from where the rewind began.
struct Lift {
  double up_mm = 0;  ///< along the tool axis
  double turn_rad = 0;
  bool is_on_axis = false;       ///< there, or with the redundant joint turned back
  bool is_other_branch = false;  ///< there, with the redundant joint elsewhere
  bool is_tilted = false;        ///< the tip is on the line, the axis on its way to the pole
};

class RewindFinder {
 public:
  RewindFinder(const ProgramStep& rest, const MachineModel& model, double tool_length_mm)
      : model_(model),
        free_(redundant_joint(model)),
        length_(tool_length_mm),
        joints_(joints_of(model, rest.drives)),
        pose_(forward(model, length_, joints_)) {}

  [[nodiscard]] Lift lift_of(const ProgramStep& step) const {
    JointVector joints = joints_of(model_, step.drives);
    const ToolPose there = forward(model_, length_, joints);
    const double turn = joints[free_] - joints_[free_];
    joints[free_] = joints_[free_];
    Lift held = seen(forward(model_, length_, joints), turn);
    if (held.is_on_axis) return held;
    Lift lift = seen(there, turn);
    lift.is_other_branch = lift.is_on_axis;
    return lift;
  }

 private:
  [[nodiscard]] Lift seen(const ToolPose& at, double turn) const {
    const Vector3 off = at.tip - pose_.tip;
    const double up = off.dot(pose_.axis);
    const bool is_on_line = (off - up * pose_.axis).norm() <= kPlace_mm && up >= -kPlace_mm;
    Lift lift{up, turn};
    lift.is_on_axis = is_on_line && angle_between(at.axis, pose_.axis) <= kAngle_rad;
    lift.is_tilted = is_on_line && !lift.is_on_axis &&
                     record::is_towards_pole(model_, pose_.axis, at.axis, kAngle_rad);
    return lift;
  }

  const MachineModel& model_;
  int free_;
  double length_;
  JointVector joints_;
  ToolPose pose_;
};

bool is_whole_turn(double turn) {
  return std::abs(turn) > 1 && std::abs(std::remainder(turn, kTurn_rad)) <= kAngle_rad;
}

}  // namespace

std::optional<std::size_t> find_rewind(const ProgramStep& rest, std::span<const ProgramStep> steps,
                                       const MachineModel& model, const RewindLimits& limits) {
  if (redundant_joint(model) < 0 || steps.empty() ||
      steps.front().kind != ProgramStep::Kind::kRapid || !rest.is_placed || rest.tool_pose) {
    return std::nullopt;
  }
  const RewindFinder finder(rest, model, limits.tool_length_mm);
  Lift before;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const ProgramStep& step = steps[n];
    const bool moves =
        step.kind == ProgramStep::Kind::kRapid || step.kind == ProgramStep::Kind::kCut;
    if (!moves || !step.is_placed || step.tool_pose) return std::nullopt;
    const Lift now = finder.lift_of(step);
    const bool turns = now.is_tilted || now.is_other_branch != before.is_other_branch ||
                       std::abs(now.turn_rad - before.turn_rad) > kAngle_rad;
    const bool is_clear =
        before.up_mm >= limits.clear_mm && std::abs(now.up_mm - before.up_mm) < kPlace_mm;
    if (!(now.is_on_axis || now.is_tilted) || (turns && !is_clear)) return std::nullopt;
    if (now.up_mm <= kPlace_mm) {
      const bool is_rewound = now.is_other_branch || is_whole_turn(now.turn_rad);
      return is_rewound ? std::optional(n) : std::nullopt;
    }
    before = now;
  }
  return std::nullopt;
}

}  // namespace meridian::proof
