// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/kinematics.hpp"

namespace meridian {
namespace {

constexpr double kStepShare = 0.3;       // of the distance to the pole, that the axis turns at once
constexpr double kPoleTolerances = 2.5;  // nearer a smooth run may change the branch
constexpr double kLeastPole_rad = 1e-3;
constexpr int kMostSteps = 256;  // per block
constexpr double kMargin_rad = 1e-9;

/// One branch, followed from the start with the free joint anywhere.
class Follower {
 public:
  Follower(const MachineModel& model, double tool_length_mm, int branch, const ToolPose& start,
           std::span<AheadWay> ways) noexcept
      : model_(model),
        tool_length_mm_(tool_length_mm),
        branch_(branch),
        free_(free_joint(model)),
        pole_rad_(std::max(kPoleTolerances * axis_tolerance_beside_pole(model), kLeastPole_rad)),
        pose_(start),
        ways_(ways) {
    const auto at = solve(model_, tool_length_mm_, start, branch_, JointVector{});
    is_over_ = at.status != SolveStatus::kOk || pole_distance(model_, start.axis) < pole_rad_;
    joints_ = at.q;
    begin_ = joints_[free_];
  }

  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

  void follow(const ClBlock& block) noexcept {
    if (is_motion(block.kind)) run_to({to_vector(block.tip_mm), to_vector(block.axis)});
    if (is_over_) return;
    for (AheadWay& way : ways_) {
      if (way.branch == branch_ && !way.is_out) ++way.carries;
    }
  }

 private:
  void run_to(ToolPose end) noexcept {
    const auto unit = UnitVector3::near_unit(end.axis);
    if (!unit || !end.tip.allFinite()) {
      is_over_ = true;
      return;
    }
    end.axis = unit->vector();
    const GreatCircle circle = find_great_circle(pose_.axis, end.axis);
    double turned = 0;
    for (int n = 0; turned < circle.turn && !is_over_; ++n) {
      const Vector3 here = std::cos(turned) * circle.begin + std::sin(turned) * circle.normal;
      turned = std::min(circle.turn, turned + kStepShare * pole_distance(model_, here));
      const Vector3 axis = std::cos(turned) * circle.begin + std::sin(turned) * circle.normal;
      is_over_ = n == kMostSteps || !circle.is_unique || !put_at({end.tip, axis});
    }
    pose_ = end;
  }

  /// False: the branch cannot be followed there.
  [[nodiscard]] bool put_at(const ToolPose& pose) noexcept {
    const auto at = solve(model_, tool_length_mm_, pose, branch_, joints_);
    if (at.status != SolveStatus::kOk || pole_distance(model_, pose.axis) < pole_rad_) return false;
    joints_ = at.q;
    bool is_any_inside = false;
    for (AheadWay& way : ways_) {
      if (way.branch != branch_ || way.is_out) continue;
      way.is_out = !is_inside(way.free + joints_[free_] - begin_);
      is_any_inside |= !way.is_out;
    }
    return is_any_inside;
  }

  [[nodiscard]] bool is_inside(double free) const noexcept {
    for (int i = 0; i < model_.joint_count; ++i) {
      if (!model_.joints[i].is_rotary) continue;
      const double at = i == free_ ? free : joints_[i];
      if (!is_inside_travel(model_.joints[i], at, kMargin_rad)) return false;
    }
    return true;
  }

  const MachineModel& model_;
  double tool_length_mm_;
  int branch_, free_;
  double pole_rad_;
  ToolPose pose_;
  std::span<AheadWay> ways_;
  JointVector joints_{};
  double begin_ = 0;  ///< of the free joint
  bool is_over_ = false;
};

}  // namespace

void look_ahead(const MachineModel& model, double tool_length_mm, const ToolPose& start,
                std::span<const ClBlock> blocks, std::span<AheadWay> ways) noexcept {
  if (blocks.empty()) return;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    Follower follower(model, tool_length_mm, branch, start, ways);
    for (const ClBlock& block : blocks.subspan(1)) {
      if (follower.is_over()) break;
      follower.follow(block);
    }
  }
}

}  // namespace meridian
