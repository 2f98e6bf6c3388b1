// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian {

/// Where a feed override above 100 % holds from in what is planned, and how many blocks were looked
/// at before a choice: with the blocks, these marks say all of what a plan depends on.
/// Proof: tests/property/cycle/feed_raise_test.cpp, tests/property/planner/look_ahead_test.cpp.
struct FeedMark {
  bool is_begin = false;       ///< a program begins, at 100 %
  std::uint64_t sequence = 0;  ///< CL block
  std::uint32_t span = 0;      ///< of the smooth path, counted from the block's first
  double factor = 1;           ///< of the programmed feed, at least 1
  /// Else 0: branch and winding follow from so many blocks: those at the program's begin, or, where
  /// `sequence` is not 0, that block and those behind it, past the pole.
  std::uint64_t looked_at = 0;
  bool is_late = false;       ///< of looked_at: no more were waited for
  double tool_length_mm = 0;  ///< of is_begin: of the tool in the spindle; 0: not known
};

/// How far ahead of the cycle a planner keeps, that is to obey an override above 100 %, s: soon
/// enough for an operator, far enough for a planner that has to wait for the processor.
inline constexpr double kFeedHorizon_s = 2.0;

}  // namespace meridian
