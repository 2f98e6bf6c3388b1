// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/cell_blocks.hpp"

#include <algorithm>

namespace meridian {
namespace {

void raise(CellBound::Sides& all, const CellBound::Sides& one) noexcept {
  all.up = all.up.max(one.up);
  all.down = all.down.max(one.down);
}

CellBlock block_of(const CellGrid& grid, std::int64_t first_cell) noexcept {
  const FeedCell& first = grid[first_cell];
  CellBlock block{{}, first.max_b, first.made_tight, first.bound};
  block.h[0] = first.h;
  for (int n = 1; n < CellBlock::kCells; ++n) {
    const FeedCell& cell = grid[first_cell + n];
    block.h[static_cast<std::size_t>(n)] = cell.h;
    block.max_b = std::min(block.max_b, cell.max_b);
    block.made_tight = std::min(block.made_tight, cell.made_tight);
    raise(block.bound.d1, cell.bound.d1);
    raise(block.bound.d2, cell.bound.d2);
    raise(block.bound.d3, cell.bound.d3);
    block.bound.rate = block.bound.rate.max(cell.bound.rate);
  }
  return block;
}

}  // namespace

void CellBlocks::begin(const CellGrid& grid, std::int64_t rest_cell) noexcept {
  constexpr std::int64_t kCells = CellBlock::kCells;
  constexpr auto kRoom = static_cast<std::int64_t>(kBlocks) * kCells;
  const std::int64_t first = std::max(grid.first(), rest_cell - kRoom);
  begin_ = (first + kCells - 1) / kCells * kCells;
  for (end_ = begin_; end_ + kCells <= rest_cell; end_ += kCells) {
    blocks_[index(end_)] = block_of(grid, end_);
  }
}

}  // namespace meridian
