// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "meridian/planner/time_piece.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/cells/feed_rest.hpp"
#include "service/core/planner/feed/solver/feed_check.hpp"
#include "service/core/planner/feed/solver/jerk_step.hpp"

namespace meridian {

/// A stretch of time of a planned feed: s⃛ = j + k ṡ on the span, as a TimePiece has it.
struct FeedPiece {
  std::uint64_t span = 0;  ///< counts spans of the path
  std::int64_t cell = 0;
  double duration = 0;
  double s0 = 0, v = 0, a = 0, j = 0, k = 0;
};

/// Its law, from its begin on.
inline void put_law(const FeedPiece& piece, TimePiece& time) noexcept {
  time.duration = piece.duration;
  time.s0 = piece.s0;
  time.v = piece.v;
  time.a = piece.a;
  time.j = piece.j;
  time.k = piece.k;
}

/// Pieces of a window of at most so many cells, in order, in a fixed store.
class FeedPieces {
 public:
  static constexpr int kMaxParts = 64;   ///< that a cell is cut into
  static constexpr int kMeanParts = 32;  ///< that there is room for; a cell has hardly ever four

  explicit FeedPieces(int max_cells)
      : capacity_(static_cast<std::size_t>(max_cells + 2) * kMeanParts) {
    pieces_.reserve(capacity_);
  }
  void clear() noexcept {
    pieces_.clear();
    is_cut_short_ = false;
  }
  /// Whether a piece found no room since clear(): the window has to be planned otherwise.
  [[nodiscard]] bool is_cut_short() const noexcept { return is_cut_short_; }
  [[nodiscard]] const std::vector<FeedPiece>& all() const noexcept { return pieces_; }

  /// ṡ² quadratic in the cell: j = 0, k = b''/2. Cut so that |k| t² <= 1, where the series of the
  /// law is exact to rounding.
  void add(const FeedCell& cell, std::int64_t number, const CellLaw& law) noexcept;
  /// The first or last cell of a motion.
  void add(const FeedCell& cell, std::int64_t number, const RestCell& rest, bool is_start) noexcept;
  /// The crawl from cell `first` on, cut at cells and phases.
  void add(const CellGrid& grid, std::int64_t first, const Crawl& crawl) noexcept;

 private:
  void add(const FeedPiece& piece) noexcept {
    is_cut_short_ = is_cut_short_ || pieces_.size() == capacity_;
    if (!is_cut_short_) pieces_.push_back(piece);
  }
  std::size_t capacity_;
  bool is_cut_short_ = false;
  std::vector<FeedPiece> pieces_;
};

}  // namespace meridian
