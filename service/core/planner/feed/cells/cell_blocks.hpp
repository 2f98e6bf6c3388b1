// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "service/core/planner/feed/cells/feed_cells.hpp"

namespace meridian {

/// Neighbouring cells as one: what bounds each of them.
struct CellBlock {
  static constexpr int kCells = 8;

  std::array<double, kCells> h{};  ///< lengths of the cells
  double max_b = 0;                ///< least of theirs
  double made_tight = 1;           ///< least of theirs
  CellBound bound;                 ///< largest of theirs
};

/// The blocks of a window's cells. What holds for a block holds for its cells, so a search along
/// many cells looks at one of them only where its block does not pass. RT: no allocation.
class CellBlocks {
 public:
  /// Takes the cells of `grid` before `rest_cell` as they are now, the last 512 at most.
  void begin(const CellGrid& grid, std::int64_t rest_cell) noexcept;

  /// The block that begins with `cell`, or nullptr: none does, or not all of it lies before the
  /// rest.
  [[nodiscard]] const CellBlock* find(std::int64_t cell) const noexcept {
    const bool is_known = cell >= begin_ && cell < end_ && cell % CellBlock::kCells == 0;
    return is_known ? &blocks_[index(cell)] : nullptr;
  }

 private:
  static constexpr std::size_t kBlocks = 64;

  [[nodiscard]] static std::size_t index(std::int64_t cell) noexcept {
    return static_cast<std::size_t>(cell / CellBlock::kCells) & (kBlocks - 1);
  }

  std::array<CellBlock, kBlocks> blocks_;
  std::int64_t begin_ = 0, end_ = 0;  ///< cells of the blocks
};

}  // namespace meridian
