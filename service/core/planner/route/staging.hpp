// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/path/path_piece.hpp"
#include "meridian/planner/time_piece.hpp"

namespace meridian {

/// Pieces of a block that is being planned: nothing of it is seen outside until all of it is
/// checked. Fixed store.
struct Staging {
  std::array<PathPiece, 512> paths;
  std::array<TimePiece, 4096> times;
  int path_count = 0;
  int time_count = 0;
  std::uint64_t first_index = 0;  ///< index of the first path piece

  void clear(std::uint64_t index) noexcept {
    path_count = time_count = 0;
    first_index = index;
  }

  /// A point to go back to.
  struct Mark {
    int paths = 0, times = 0;
  };
  [[nodiscard]] Mark mark() const noexcept { return {path_count, time_count}; }
  void go_back(const Mark& mark) noexcept {
    path_count = mark.paths;
    time_count = mark.times;
  }

  /// How long what was added since takes, s.
  [[nodiscard]] double duration_since(const Mark& mark) const noexcept {
    double sum = 0;
    for (int n = mark.times; n < time_count; ++n) sum += times[n].duration;
    return sum;
  }

  /// Adds a path piece, which gets the next index.
  [[nodiscard]] bool add(const PathPiece& piece) noexcept {
    if (path_count == static_cast<int>(paths.size())) return false;
    paths[path_count] = piece;
    paths[path_count].index = first_index + static_cast<std::uint64_t>(path_count);
    ++path_count;
    return true;
  }
  [[nodiscard]] bool add(const TimePiece& piece) noexcept {
    if (time_count == static_cast<int>(times.size())) return false;
    times[time_count++] = piece;
    return true;
  }
};

}  // namespace meridian
