// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace meridian {

/// The place on a path piece where a block ends.
struct BlockMark {
  double s = 0;             ///< path length from the begin of the piece, mm
  std::uint32_t ahead = 0;  ///< the block's sequence, counted from that of the piece
  std::uint32_t line = 0;   ///< its source line
};

/// The ends of blocks on a path piece, in order. Where there are more than kMax the last one moves
/// on: the blocks from there on count as one. Trivially copyable, fixed size.
struct BlockMarks {
  static constexpr std::uint32_t kMax = 16;
  std::uint32_t count = 0;
  std::array<BlockMark, kMax> at{};

  void add(const BlockMark& mark) noexcept {
    if (count < kMax) ++count;
    at[count - 1] = mark;
  }
};
static_assert(std::is_trivially_copyable_v<BlockMarks>);

}  // namespace meridian
