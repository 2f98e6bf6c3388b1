// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead.hpp"

#include <algorithm>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/ahead_follower.hpp"

namespace meridian {

void look_ahead(const MachineModel& model, double tool_length_mm, const ToolPose& start,
                const AheadSlack& slack, std::span<const ClBlock> blocks,
                std::span<AheadWay> ways) noexcept {
  if (blocks.empty()) return;
  const auto to_follow = blocks.front().is_arc ? blocks : blocks.subspan(1);
  for (int branch = 0; branch < branch_count(model); ++branch) {
    AheadFollower follower(model, tool_length_mm, slack, branch, start, ways);
    for (const ClBlock& block : to_follow) {
      if (follower.is_over()) break;
      follower.follow(block);
    }
  }
}

}  // namespace meridian
