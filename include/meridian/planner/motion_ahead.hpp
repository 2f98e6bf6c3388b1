// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "meridian/planner/motion_port.hpp"

namespace meridian {

/// The pieces behind the one in force, in the order in which the cycle will run them if nothing
/// more is published: as far as the plan's next rest. Valid until the reader advances. RT: cycle.
class MotionAhead {
 public:
  /// Only while a motion is in force.
  explicit MotionAhead(MotionReader& reader) noexcept
      : reader_(reader), is_in_tail_(reader.piece()->is_tail) {
    window_ = reader.piece()->window;
  }

  /// The piece that follows, nullptr where the plan rests before it.
  [[nodiscard]] const TimePiece* next() noexcept {
    for (;;) {
      const TimePiece* piece = reader_.look_ahead(++slot_);
      if (piece == nullptr || piece->epoch != reader_.epoch()) return nullptr;
      if (is_in_tail_ && !(piece->is_tail && piece->window == window_)) return nullptr;
      if (piece->is_tail && !is_in_tail_) {
        if (const std::size_t after = reader_.find_after_tail(slot_); after > 0) {
          slot_ = after - 1;
          continue;
        }
        is_in_tail_ = true;
        window_ = piece->window;
        tail_ = piece;
      }
      return begins_at_rest(*piece) ? nullptr : piece;
    }
  }

  /// Places that were gone over so far, of tails that are skipped too.
  [[nodiscard]] std::size_t slots() const noexcept { return slot_; }

  /// The begin of a tail that next() went into and the cycle has not yet; nullptr: none.
  [[nodiscard]] const TimePiece* tail() const noexcept { return tail_; }

 private:
  MotionReader& reader_;
  std::size_t slot_ = 0;
  const TimePiece* tail_ = nullptr;
  std::uint32_t window_ = 0;
  bool is_in_tail_ = false;
};

}  // namespace meridian
