// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian {

/// A branch and winding at the pose where a way starts, and how far it leads.
struct AheadWay {
  int branch = 0;
  double free = 0;    ///< the free joint at the start, rad
  int carries = 0;    ///< blocks after which all is still inside travel, of those looked at
  double time_s = 0;  ///< of them: by the feed, or by the joint that is slowest
  bool is_out = false;
};

/// Follows the joints over `blocks` from `start`, the pose at the end of the first of them (an
/// arc: at its begin), on the branch of every way, and counts how many blocks each of `ways`
/// carries: as long as no joint and no drive of a stage is outside its travel. Behind a tool block,
/// whose length is not known here, rotary joints alone are judged. Tip and axis run on the
/// programmed lines, arcs and great circles; the look ends where the axis comes so close to the
/// pole that the branch may be chosen anew. From a start that is so close it is followed out first;
/// from a start on the pole it sees nothing.
///
/// The machine has a free joint. Bounded by the blocks, no memory. Units: mm, rad, s.
void look_ahead(const MachineModel& model, double tool_length_mm, const ToolPose& start,
                std::span<const ClBlock> blocks, std::span<AheadWay> ways) noexcept;

}  // namespace meridian
