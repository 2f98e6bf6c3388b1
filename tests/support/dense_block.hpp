// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "meridian/path/cl_block.hpp"

namespace meridian::test {

/// Block `i` of a finish without end: `step` mm to the next on a curve that winds, tilts and turns.
[[nodiscard]] inline ClBlock dense_block(std::uint64_t i, double step, double feed) {
  const double u = step * static_cast<double>(i);
  const double tilt = 0.35 + 0.2 * std::sin(u / 35), azimuth = u / 80;
  ClBlock block;
  block.sequence = i;
  block.line = static_cast<std::uint32_t>(i + 1);
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = feed;
  block.tip_mm = {60 * std::cos(u / 60), 60 * std::sin(u / 60), 4 * std::sin(u / 7)};
  block.axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                std::cos(tilt)};
  return block;
}

}  // namespace meridian::test
