// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "meridian/path/cl_block.hpp"

namespace meridian::bench {

/// Block `i` of a five-axis program without end: cuts of 3 mm at 1200 mm/min to and fro on
/// a circle of 40 mm radius, the axis tilting between 9 and 22 degrees as it goes.
[[nodiscard]] inline ClBlock block_on_path(std::uint64_t i) noexcept {
  constexpr std::uint64_t kBlocksOneWay = 84;
  const std::uint64_t phase = i % (2 * kBlocksOneWay);
  const auto step = static_cast<double>(phase < kBlocksOneWay ? phase : 2 * kBlocksOneWay - phase);
  const double turn = 2.0 * std::numbers::pi * step / static_cast<double>(kBlocksOneWay);
  const double tilt = 0.27 + 0.11 * std::sin(0.37 * turn);
  ClBlock block;
  block.sequence = i;
  block.line = static_cast<std::uint32_t>(i + 1);
  block.kind = BlockKind::kCut;
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = 20;
  block.tip_mm = {40.0 * std::cos(turn), 40.0 * std::sin(turn), 0.02 * step};
  block.axis = {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)};
  return block;
}

}  // namespace meridian::bench
