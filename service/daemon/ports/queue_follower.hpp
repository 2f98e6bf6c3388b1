// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/daemon/ports/ports.hpp"

namespace meridian::interpolator {

/// The planner's look at the block queue: which block is next, and whether it may be planned now.
///
/// The cycle ends a program by the next epoch; intake hears of it later and then writes one
/// QueueMark: what was pushed so far is void, what comes is meant for that epoch. The planner may
/// be held up anywhere in between, for any time. It looks at (1) the front block, (2) the mark,
/// (3) the cycle's view, in this order, and a block is in step if it is not void by the mark and
/// the epochs of mark and view are the same. Then the block is planned for the epoch it was meant
/// for, from a point where the machine has been since:
///
/// * Let M be the mark in force when the block was pushed. Intake wrote M before it published the
///   block, so who sees the block (1) sees M or a later mark (2). A later mark that says the block
///   is void is obeyed. One that does not differs from M in the epoch alone: drives were enabled,
///   and intake left the queue as it was, meant for the new epoch. So the block is meant for the
///   epoch of the mark that was seen.
/// * Everything that the cycle showed before that block was pushed is seen too, because intake
///   pushes the first block of a program after it heard of the end of the one before: the view (3)
///   is not from before that end, and a Ready in it is the rest that this program starts from.
/// * What the cycle or intake do after (3) voids the block or leaves it good. If it is voided,
///   pieces made of it carry the epoch that is over and the cycle drops them.
///
/// Looking at the view and the mark before the block would let the first block of a new program,
/// pushed in between, be planned for the old epoch, and be lost; two words instead of one mark
/// would let a block of the old program be planned for the new epoch, and be run at the next start.
/// One thread. Proof: tests/unit/daemon/queue_follower_test.cpp, which holds it between any
/// two looks.
class QueueFollower {
 public:
  struct Look {
    const QueuedBlock* front = nullptr;  ///< nullptr: the queue is empty
    bool is_in_step = false;             ///< `front` may be planned for the epoch of the view
    bool is_emptied = false;             ///< what came before is void: look again
    bool is_new_epoch = false;           ///< a plan that was begun is void
  };

  explicit QueueFollower(Ports& ports) noexcept : ports_(ports) {}

  /// `pause` is called between any two looks at what other threads write.
  template <class Pause>
  [[nodiscard]] Look look(Pause pause) noexcept {
    Look look;
    look.front = ports_.blocks.peek(0);
    pause();
    const QueueMark mark = ports_.queue_mark.load();
    pause();
    if (ports_.planner_view.refresh()) {
      look.is_new_epoch = ports_.planner_view.latest().epoch != view().epoch;
      view_ = ports_.planner_view.latest();
    }
    look.is_emptied = mark.until != until_;
    look.is_in_step = !look.is_emptied && mark.epoch == view_.epoch;
    until_ = mark.until;
    // What is void was published before the mark: peek() shows all of it.
    while (popped_ < until_ && ports_.blocks.peek(0) != nullptr) pop();
    return look;
  }
  [[nodiscard]] Look look() noexcept {
    return look([] {});
  }

  /// The front block is dealt with.
  void pop() noexcept {
    ports_.blocks.drop(1);
    ++popped_;
  }

  /// The cycle's as of the newest look.
  [[nodiscard]] const CycleView& view() const noexcept { return view_; }

 private:
  Ports& ports_;
  CycleView view_;
  std::uint64_t until_ = 0;   ///< of the newest mark that was followed
  std::uint64_t popped_ = 0;  ///< blocks taken from the queue, ever
};

}  // namespace meridian::interpolator
