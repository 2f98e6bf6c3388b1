// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian {

/// A branch and winding at the pose where a program starts, and how far it leads.
struct AheadWay {
  int branch = 0;
  double free = 0;  ///< the free joint at the start, rad
  int carries = 0;  ///< blocks after which it is still inside travel, of those looked at
  bool is_out = false;
};

/// Follows the rotary joints over `blocks` from `start`, the pose at the end of the first of them,
/// on the branch of every way, and counts how many blocks each of `ways` carries: as long as no
/// rotary joint is outside its travel. The tool axis runs on great circles between block ends; the
/// look ends where it comes so close to the pole that the branch may be chosen anew.
///
/// The machine has a free joint. Bounded by the blocks, no memory. Unit: rad.
void look_ahead(const MachineModel& model, double tool_length_mm, const ToolPose& start,
                std::span<const ClBlock> blocks, std::span<AheadWay> ways) noexcept;

}  // namespace meridian
