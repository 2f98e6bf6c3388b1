// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian::test {

/// The axis `tilt` off +z towards `azimuth`. Unit: rad.
[[nodiscard]] inline Vector3 tilted(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

/// Block `n` of a program, in line n + 1: a cut to `pose` at 50 mm/s of the tip.
[[nodiscard]] inline ClBlock cut_block(int n, const ToolPose& pose) {
  ClBlock block;
  block.kind = BlockKind::kCut;
  block.tip_mm = to_array(pose.tip);
  block.axis = to_array(pose.axis);
  block.feed = 50;
  block.feed_meaning = FeedMeaning::kTip;
  block.sequence = static_cast<std::uint64_t>(n);
  block.line = static_cast<std::uint32_t>(n + 1);
  return block;
}

/// Puts the block after the last that ends a program.
inline void end_program(std::vector<ClBlock>& blocks) {
  ClBlock end;
  end.kind = BlockKind::kEnd;
  end.sequence = blocks.size();
  end.line = 10 * static_cast<std::uint32_t>(end.sequence) + 7;
  blocks.push_back(end);
}

/// Numbers blocks in their order, and ends their program.
inline void number_and_end(std::vector<ClBlock>& blocks) {
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n].sequence = n;
  end_program(blocks);
}

}  // namespace meridian::test
