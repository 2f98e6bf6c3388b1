// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/programs/post/post_options.hpp"
#include "service/programs/post/subdivide.hpp"

namespace meridian::post {

/// A stretch of one block's way. `piece` grows evenly with its share of the way; see plain().
struct PlannedPiece {
  PathPiece piece;
  double feed_mm_per_s = 0;  ///< of the tip; 0: rapid
};

/// The way that the service takes from block to block: its planner is asked, so that branch,
/// winding, travel, and what happens on the pole are decided once for both. Of the planner's motion
/// the geometry alone is kept. Context: I/O.
class PlannedPath {
 public:
  /// A rewind is pieces of MotionKind::kRewind, for blocks that say the drives; else it is refused.
  PlannedPath(const MachineModel& model, ToolTable tools, BlockMotion motion);

  /// The pieces of `programmed` in order; empty where it does not move. `ahead`: it and what
  /// follows, through which branch and winding are to carry.
  [[nodiscard]] Expected<std::vector<PlannedPiece>, PostError> plan(const ClBlock& programmed,
                                                                    std::span<const ClBlock> ahead);

  /// The next motion block is approached anew: after a tool change nobody knows the way there.
  void begin_again();

  [[nodiscard]] const JointVector& joints() const noexcept { return planner_.joints(); }
  [[nodiscard]] double tool_length_mm() const noexcept { return planner_.tool_length_mm(); }

 private:
  [[nodiscard]] ClBlock inside_travel(ClBlock block) const;

  const MachineModel& model_;
  const BlockMotion motion_;
  std::unique_ptr<MotionPort> port_;
  MotionWriter writer_;
  RestToRestPlanner planner_;
  std::uint16_t epoch_ = 1;
};

/// Length of the way that `piece` stands for, whichever way its s runs: what shares of a block's
/// time are measured by. 0 for turns on the pole and joint moves. Unit: mm.
[[nodiscard]] double path_length(const PathPiece& piece) noexcept;

/// False for the ways to the first point and for rewinds, which no block of the CL file times.
[[nodiscard]] constexpr bool is_of_block(const PathPiece& piece) noexcept {
  return piece.motion != MotionKind::kApproach && piece.motion != MotionKind::kRewind;
}

}  // namespace meridian::post
