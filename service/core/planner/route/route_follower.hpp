// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/core/planner/route/route_ahead.hpp"

namespace meridian {

/// One branch, followed over programmed blocks from a start with the redundant joint anywhere:
/// checks those of some routes that are on the branch. Tip and axis run on the programmed lines,
/// arcs and great circles. Behind a tool block, whose length is not known here, rotary joints alone
/// are checked. It ends where the axis comes so close to the pole that the branch may be chosen
/// anew. From a start that is so close it is followed out first; from a start on the pole it sees
/// nothing. Where a run within the slack may leave the branch beside the pole that it begins at, no
/// route is lost.
///
/// Units: mm, rad, s. No memory.
// Flags: each is known by itself on the path, in any order.
class RouteFollower {
 public:
  /// `ways` must stay.
  RouteFollower(const MachineModel& model, double tool_length_mm, const LookAheadSlack& slack,
                int branch, const ToolPose& start, std::span<RouteAhead> routes) noexcept;

  /// The branch can be followed no farther, or none of its routes is open.
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

  void follow(const ClBlock& block) noexcept;

 private:
  void run(const ClBlock& block) noexcept;
  [[nodiscard]] double feed_time_s(const PathPiece& path, const ClBlock& block) const noexcept;
  /// False: the branch cannot be followed there. `feed_s`: the time that the feed takes there.
  [[nodiscard]] bool put_at(const ToolPose& pose, double feed_s) noexcept;
  void check(const ToolPose& pose, RouteAhead& route) const noexcept;
  /// Whether a rewind may help where `joint` runs out of travel, at `pose`.
  [[nodiscard]] bool may_rewind(int joint, const ToolPose& pose) const noexcept;
  /// Whether joints stand in a keep-out box or have the tip outside of its box. How far a run
  /// within the slack passes it is not looked at: such a route comes behind the others.
  [[nodiscard]] bool is_at_box(const JointVector& all) const noexcept;
  /// Of the joints and drives whose place is known; -1: none.
  [[nodiscard]] int first_outside(const JointVector& all) const noexcept;
  /// How far `joint` may be from where it is at `pose` on a path that keeps to the slack.
  [[nodiscard]] double spread_of(int joint, const ToolPose& pose) const noexcept;

  const MachineModel& model_;
  double tool_length_mm_;
  LookAheadSlack slack_;
  int branch_, free_;
  double pole_rad_;
  ToolPose pose_;
  const ClBlock* block_ = nullptr;  ///< that is followed
  std::span<RouteAhead> routes_;
  JointVector joints_{};
  double begin_ = 0;  ///< of the redundant joint
  double time_s_ = 0;
  bool is_over_ = false;
  bool has_left_pole_ = false;      ///< it was far enough from the pole once
  bool is_branch_certain_ = false;  ///< a run that keeps to the slack leaves it nowhere
  bool is_tool_known_ = true;
};

}  // namespace meridian
