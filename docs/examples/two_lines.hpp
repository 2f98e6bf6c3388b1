// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/path/cl_block.hpp"

/// Rapid to (0, 0, 50), down to the part, 30 mm along x, end. mm, mm/s.
[[nodiscard]] inline std::array<meridian::ClBlock, 4> two_lines() {
  using meridian::BlockKind;
  constexpr auto kFeed = meridian::FeedMeaning::kTip;
  return {{{.sequence = 0, .line = 1, .kind = BlockKind::kRapid, .tip_mm = {0, 0, 50}},
           {.sequence = 1, .line = 2, .feed_meaning = kFeed, .tip_mm = {0, 0, 0}, .feed = 15},
           {.sequence = 2, .line = 3, .feed_meaning = kFeed, .tip_mm = {30, 0, 0}, .feed = 15},
           {.sequence = 3, .line = 4, .kind = BlockKind::kEnd}}};
}
