// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/robot_look_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"

namespace meridian {
namespace {

constexpr double kLongestStep_mm = 5;  // of path length
constexpr double kShortestStep_mm = 1e-3;
constexpr double kMaxTurn_rad = 0.3;  // of a joint in one step
constexpr int kMaxSteps = 8192;       // of a course

class Course {
 public:
  Course(const MachineModel& model, const LookAheadSlack& slack, const RobotStart& start) noexcept
      : model_(model), slack_(slack), at_(start) {
    inside_ = singularity_at(at_.pose);
  }

  /// False: it ends on the way.
  [[nodiscard]] bool follow(const ClBlock& block) noexcept {
    if (block.kind == BlockKind::kTool) return false;
    if (!is_motion(block.kind)) return true;
    const auto unit = UnitVector3::near_unit(to_vector(block.axis));
    const ToolPose end{to_vector(block.tip_mm), unit ? unit->vector() : Vector3::UnitZ()};
    if (!unit || !end.tip.allFinite()) return false;
    const PathPiece path = block.is_arc ? make_arc(at_.pose, end, block) : make_line(at_.pose, end);
    double step = kLongestStep_mm;
    for (double s = 0; s < path.length;) {
      if (++steps_ > kMaxSteps) return false;
      const double next = std::min(path.length, s + step);
      const bool may_halve = next - s > kShortestStep_mm;
      const Move move = move_to(pose_at(path, next), may_halve);
      if (move == Move::kTooFar) {
        step = 0.5 * (next - s);
        continue;
      }
      if (move == Move::kEnds) return false;
      s = next;
      step = std::min(kLongestStep_mm, 2 * step);
    }
    at_.pose = end;
    return true;
  }

 private:
  enum class Move { kDone, kTooFar, kEnds };

  /// The singular place that the pose lies at within the slack, if there is one.
  [[nodiscard]] const Singularity* singularity_at(const ToolPose& pose) const noexcept {
    static constexpr Singularity kSingularities[] = {Singularity::kShoulder, Singularity::kWrist};
    for (const Singularity& at : kSingularities) {
      const double near = at == Singularity::kWrist ? slack_.axis_rad : slack_.tip_mm;
      if (distance(at, pose) < near) return &at;
    }
    return nullptr;
  }
  [[nodiscard]] double distance(Singularity at, const ToolPose& pose) const noexcept {
    return singular_distance(model_, at_.tool_length_mm, at, pose, at_.branch, at_.joints);
  }

  [[nodiscard]] Move move_to(const ToolPose& pose, bool may_halve) noexcept {
    const Singularity* const inside = singularity_at(pose);
    if (inside != nullptr) {  // the redundant joint rests, whatever the others do
      inside_ = inside;
      return Move::kDone;
    }
    const Singularity* const left = std::exchange(inside_, nullptr);
    int branch = at_.branch;
    auto to = solve_on(pose, branch);
    if (left != nullptr) {
      const int over = branch ^ (*left == Singularity::kWrist ? robot::kFlip : robot::kBack);
      const auto other = solve_on(pose, over);
      const bool is_better =
          is_inside(other) && (!is_inside(to) || turn_to(other.q) < turn_to(to.q));
      if (is_better) {
        to = other;
        branch = over;
      }
    } else if (may_halve && to.status != SolveStatus::kUnreachable &&
               turn_to(to.q) > kMaxTurn_rad) {
      return Move::kTooFar;
    }
    if (!is_inside(to)) return Move::kEnds;
    at_.joints = to.q;
    at_.branch = branch;
    return Move::kDone;
  }
  [[nodiscard]] Solution<double> solve_on(const ToolPose& pose, int branch) const noexcept {
    return solve(model_, at_.tool_length_mm, pose, branch, at_.joints);
  }
  [[nodiscard]] bool is_inside(const Solution<double>& to) const noexcept {
    return to.status != SolveStatus::kUnreachable &&
           first_joint_outside_travel(model_, to.q, kTravelMargin) < 0 &&
           keep_out_at(model_.keep_out, to.q) < 0 &&
           tip_axis_outside(model_, at_.tool_length_mm, to.q) < 0;
  }
  [[nodiscard]] double turn_to(const JointVector& q) const noexcept {
    double largest = 0;
    for (int i = 0; i < model_.joint_count; ++i) {
      largest = std::max(largest, std::abs(q[i] - at_.joints[i]));
    }
    return largest;
  }

  const MachineModel& model_;
  LookAheadSlack slack_;
  RobotStart at_;
  const Singularity* inside_ = nullptr;
  int steps_ = 0;
};

}  // namespace

int follow_ahead(const MachineModel& model, const LookAheadSlack& slack, const RobotStart& start,
                 std::span<const ClBlock> blocks) noexcept {
  Course course(model, slack, start);
  int carries = 0;
  for (const ClBlock& block : blocks) {
    if (!course.follow(block)) break;
    ++carries;
  }
  return carries;
}

}  // namespace meridian
