// SPDX-License-Identifier: Apache-2.0
#include "service/programs/proof/rewind.hpp"

#include <cmath>
#include <cstdint>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/winding.hpp"
#include "service/recording/record/check/path/towards_pole.hpp"

namespace meridian::proof {
namespace {

constexpr double kPosition_mm = 1e-3;  // words are rounded to 0.1 um and 0.1 urad
constexpr double kAngle_rad = 1e-6;

/// Where a step stands as seen from where the rewind began.
struct Lift {
  enum class Pose : std::uint8_t {
    kElsewhere,
    kOnAxis,       ///< there, or with the redundant joint turned back
    kOtherBranch,  ///< there, with the redundant joint elsewhere
    kTilted        ///< the tip is on the line, the axis between there and the pole
  };
  double up_mm = 0;  ///< along the tool axis
  double turn_rad = 0;
  Pose pose = Pose::kElsewhere;
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
    const Lift held = seen(forward(model_, length_, joints), turn);
    if (held.pose == Lift::Pose::kOnAxis) return held;
    Lift lift = seen(there, turn);
    if (lift.pose == Lift::Pose::kOnAxis) lift.pose = Lift::Pose::kOtherBranch;
    return lift;
  }

 private:
  [[nodiscard]] Lift seen(const ToolPose& at, double turn) const {
    const Vector3 off = at.tip - pose_.tip;
    const double up = off.dot(pose_.axis);
    const bool is_on_line = (off - up * pose_.axis).norm() <= kPosition_mm && up >= -kPosition_mm;
    if (!is_on_line) return {up, turn, Lift::Pose::kElsewhere};
    if (angle_between(at.axis, pose_.axis) <= kAngle_rad) return {up, turn, Lift::Pose::kOnAxis};
    const bool is_tilted = record::is_towards_pole(model_, pose_.axis, at.axis, kAngle_rad);
    return {up, turn, is_tilted ? Lift::Pose::kTilted : Lift::Pose::kElsewhere};
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
    const bool is_other = now.pose == Lift::Pose::kOtherBranch;
    const bool turns = now.pose == Lift::Pose::kTilted ||
                       is_other != (before.pose == Lift::Pose::kOtherBranch) ||
                       std::abs(now.turn_rad - before.turn_rad) > kAngle_rad;
    const bool is_clear =
        before.up_mm >= limits.clear_mm && std::abs(now.up_mm - before.up_mm) < kPosition_mm;
    if (now.pose == Lift::Pose::kElsewhere || (turns && !is_clear)) return std::nullopt;
    if (now.up_mm <= kPosition_mm) {
      const bool is_rewound = is_other || is_whole_turn(now.turn_rad);
      return is_rewound ? std::optional(n) : std::nullopt;
    }
    before = now;
  }
  return std::nullopt;
}

}  // namespace meridian::proof
