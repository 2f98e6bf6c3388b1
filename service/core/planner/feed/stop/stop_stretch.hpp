// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "meridian/planner/time_law.hpp"
#include "meridian/planner/time_piece.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/rolling/feed_piece.hpp"

namespace meridian {

/// Pieces of a plan, one behind the other, that share an authority to stop. s counts from the begin
/// of the first piece's cell. RT: no allocation.
struct StopStretch {
  static constexpr std::size_t kMaxParts = 4;

  struct Part {
    std::int64_t cell = 0;
    double cell_begin = 0;  ///< s
    double duration = 0;    ///< of the piece, s of time
    PathState begin;
    std::array<PathState, 3> between;  ///< at a quarter, half and three quarters of the time
  };

  /// Of 1 to kMaxParts `pieces`, whose laws `times` have.
  StopStretch(const CellGrid& grid, std::span<const FeedPiece> pieces,
              std::span<const TimePiece> times) noexcept;

  /// Of a machine that runs through it at another rate of plan time.
  [[nodiscard]] StopStretch at_rate(double rate) const noexcept;
  /// The rate at which the machine runs through it: 1 is as planned.
  [[nodiscard]] double rate() const noexcept { return rate_; }

  [[nodiscard]] std::span<const Part> parts() const noexcept { return {parts_.data(), count_}; }
  /// State at the end of the last part.
  [[nodiscard]] const PathState& end() const noexcept { return end_; }

  /// The slowest of the states between parts and at both ends, mm/s.
  [[nodiscard]] double min_velocity() const noexcept;
  /// The hardest deceleration at those states, mm/s², >= 0.
  [[nodiscard]] double max_deceleration() const noexcept;

 private:
  std::array<Part, kMaxParts> parts_{};
  std::size_t count_ = 0;
  PathState end_;
  double rate_ = 1;
};

}  // namespace meridian
