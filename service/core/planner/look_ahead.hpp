// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian {

/// What became of a way as far as it was looked at.
enum class AheadEnd : std::uint8_t {
  kNone,     ///< all is inside travel
  kDoubt,    ///< something is outside, by no more than rounding inside the slack may make of it or
             ///< on a branch that is not certain
  kUnwinds,  ///< the free joint runs out of travel and may be turned back there
  kLost      ///< something leaves its travel for certain: the program cannot be cut this way
};

/// A branch and winding at the pose where a way starts, and how far it leads.
struct AheadWay {
  int branch = 0;
  double free = 0;    ///< the free joint at the start, rad
  int carries = 0;    ///< blocks after which all is still inside travel, of those looked at
  double time_s = 0;  ///< of them: by the feed, or by the joint that is slowest
  AheadEnd end = AheadEnd::kNone;
  BlockReject lost{};  ///< kLost: the block, the joint and where it comes to
};

/// How far the path that is cut may lie from the programmed one; 0: it is that one.
struct AheadSlack {
  double tip_mm = 0, axis_rad = 0;
};

/// Follows the joints over `blocks` from `start`, the pose at the end of the first of them (an
/// arc: at its begin), on the branch of every way, and counts how many blocks each of `ways`
/// carries: as long as no joint and no drive of a stage is outside its travel. Behind a tool block,
/// whose length is not known here, rotary joints alone are judged. Tip and axis run on the
/// programmed lines, arcs and great circles; the look ends where the axis comes so close to the
/// pole that the branch may be chosen anew. From a start that is so close it is followed out first;
/// from a start on the pole it sees nothing.
/// Where a run within the slack may leave the branch beside the pole it begins at, no way is lost.
///
/// The machine has a free joint. Bounded by the blocks, no memory. Units: mm, rad, s.
void look_ahead(const MachineModel& model, double tool_length_mm, const ToolPose& start,
                const AheadSlack& slack, std::span<const ClBlock> blocks,
                std::span<AheadWay> ways) noexcept;

}  // namespace meridian
