// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "meridian/planner/motion_port.hpp"

namespace meridian::certify {

/// Shows every piece of plan that is published, in order and once, before the cycle takes it. For
/// the thread that is both ends of the port.
class PlanTap {
 public:
  explicit PlanTap(MotionPort& port) noexcept : port_(port) {}

  /// Calls `take(piece, path)` for what was published since the last call; `path` is nullptr for
  /// rests. To be called whenever something may have been, before step().
  template <class Take>
  void look(Take take) {
    for (const TimePiece* piece = port_.times.peek(shown_); piece != nullptr;
         piece = port_.times.peek(++shown_)) {
      take(*piece, piece->kind == TimeKind::kMove ? find_path(*piece) : nullptr);
    }
  }

  /// To be called behind step(), which drops pieces and publishes none.
  void note_dropped() noexcept { shown_ = port_.times.size(); }

 private:
  [[nodiscard]] const PathPiece* find_path(const TimePiece& piece) noexcept {
    for (std::size_t i = 0;; ++i) {
      const PathPiece* path = port_.paths.peek(i);
      if (path == nullptr) return nullptr;
      if (path->epoch == piece.epoch && path->index == piece.path_index) return path;
      if (path->epoch == piece.epoch && path->index < piece.path_index) {
        const std::size_t ahead = piece.path_index - path->index;
        const PathPiece* there = port_.paths.peek(i + ahead);
        if (there != nullptr && there->epoch == piece.epoch && there->index == piece.path_index) {
          return there;
        }
      }
    }
  }

  MotionPort& port_;
  std::size_t shown_ = 0;  ///< of what the port holds
};

}  // namespace meridian::certify
