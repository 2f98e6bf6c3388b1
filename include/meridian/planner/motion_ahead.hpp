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
      const TimePiece* piece = reader_.look_ahead(++place_);
      if (piece == nullptr || piece->epoch != reader_.epoch()) return nullptr;
      if (is_in_tail_ && !(piece->is_tail && piece->window == window_)) return nullptr;
      if (piece->is_tail && !is_in_tail_) {
        if (piece->window == skipped_window_ && has_skipped_) continue;
        if (!reader_.will_run_tail(place_)) {
          skipped_window_ = piece->window;
          has_skipped_ = true;
          continue;
        }
        is_in_tail_ = true;
        window_ = piece->window;
        tail_ = piece;
      }
      return is_from_rest(*piece) ? nullptr : piece;
    }
  }

  /// The begin of a tail that next() went into and the cycle has not yet; nullptr: none.
  [[nodiscard]] const TimePiece* tail() const noexcept { return tail_; }

 private:
  [[nodiscard]] static bool is_from_rest(const TimePiece& piece) noexcept {
    return piece.kind != TimeKind::kMove || (piece.v == 0 && piece.a == 0);
  }

  MotionReader& reader_;
  std::size_t place_ = 0;
  const TimePiece* tail_ = nullptr;
  std::uint32_t window_ = 0, skipped_window_ = 0;
  bool is_in_tail_ = false, has_skipped_ = false;
};

}  // namespace meridian
