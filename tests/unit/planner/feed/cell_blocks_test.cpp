// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/cell_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::cell_blocks {
namespace {

constexpr int kCells = 60;
constexpr std::int64_t kRest = 50;

/// Cells that differ in everything.
void draw_cells(CellGrid& grid) {
  std::mt19937 random(7);
  const auto draw = [&] { return std::uniform_real_distribution<double>(0.1, 2)(random); };
  for (std::int64_t k = grid.first(); k < grid.last(); ++k) {
    FeedCell& cell = grid[k];
    cell.h = draw();
    cell.max_b = draw();
    cell.made_tight = draw();
    const auto fill = [&](CellBound::Values& values) {
      for (double& value : values) value = draw();
    };
    for (CellBound::Sides* sides : {&cell.bound.d1, &cell.bound.d2, &cell.bound.d3}) {
      fill(sides->up);
      fill(sides->down);
    }
    fill(cell.bound.rate);
  }
}

bool is_largest(const CellGrid& grid, std::int64_t first, const CellBlock& block, auto value_of) {
  CellBound::Values largest = CellBound::Values::Zero();
  for (int n = 0; n < CellBlock::kCells; ++n) {
    largest = largest.max(value_of(grid[first + n].bound));
  }
  return (value_of(block.bound) == largest).all();
}

TEST(CellBlocks, BoundEachOfTheirCells) {
  MadeCells cells(kCells);
  draw_cells(cells.grid);
  CellBlocks blocks;
  blocks.begin(cells.grid, kRest);
  for (std::int64_t cell = 0; cell + CellBlock::kCells <= kRest; cell += CellBlock::kCells) {
    const CellBlock* block = blocks.find(cell);
    ASSERT_NE(block, nullptr) << "cell " << cell;
    double min_b = 1e9, min_tight = 1e9;
    for (int n = 0; n < CellBlock::kCells; ++n) {
      const FeedCell& one = cells.grid[cell + n];
      EXPECT_EQ(block->h[static_cast<std::size_t>(n)], one.h);
      min_b = std::min(min_b, one.max_b);
      min_tight = std::min(min_tight, one.made_tight);
    }
    EXPECT_EQ(block->max_b, min_b);
    EXPECT_EQ(block->made_tight, min_tight);
    const auto check = [&](auto value_of) {
      EXPECT_TRUE(is_largest(cells.grid, cell, *block, value_of)) << "cell " << cell;
    };
    check([](const CellBound& b) { return b.d1.up; });
    check([](const CellBound& b) { return b.d1.down; });
    check([](const CellBound& b) { return b.d2.up; });
    check([](const CellBound& b) { return b.d2.down; });
    check([](const CellBound& b) { return b.d3.up; });
    check([](const CellBound& b) { return b.d3.down; });
    check([](const CellBound& b) { return b.rate; });
  }
}

TEST(CellBlocks, BeginWithEveryEighthCellAndLieWholeBeforeTheRest) {
  MadeCells cells(kCells);
  CellBlocks blocks;
  blocks.begin(cells.grid, kRest);
  for (std::int64_t cell = 0; cell < kCells; ++cell) {
    const bool is_whole = cell % CellBlock::kCells == 0 && cell + CellBlock::kCells <= kRest;
    EXPECT_EQ(blocks.find(cell) != nullptr, is_whole) << "cell " << cell;
  }
}

TEST(CellBlocks, AreThoseOfTheLastBeginAlone) {
  MadeCells cells(kCells);
  CellBlocks blocks;
  blocks.begin(cells.grid, kRest);
  cells.grid[3].max_b = 1;
  blocks.begin(cells.grid, 2 * CellBlock::kCells);
  EXPECT_EQ(blocks.find(0)->max_b, 1);
  EXPECT_EQ(blocks.find(3 * CellBlock::kCells), nullptr);
}

}  // namespace
}  // namespace meridian::test::cell_blocks
