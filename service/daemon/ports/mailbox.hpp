// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace meridian::interpolator {

/// Passes a value that has memory of its own from one thread to another: both swap, so that the
/// reading thread allocates and frees nothing. Of several that were put the reader gets the newest.
///
/// Memory order. Whoever has set kBusy has the value alone; putting and taking release it with what
/// was written, and acquire what the other one wrote.
/// Proof: tests/unit/daemon/mailbox_test.cpp.
template <class T>
class Mailbox {
 public:
  /// Writing thread: leaves `value` there, and gets what lay there before. False where the reader
  /// is at it at this moment: nothing is changed.
  [[nodiscard]] bool try_put(T& value) noexcept {
    return try_swap(State::kFull, State::kFull, value) ||
           try_swap(State::kEmpty, State::kFull, value);
  }
  /// Reading thread: takes what was put since the last time, and leaves `value` there for the
  /// writing thread to free. False where there is nothing.
  [[nodiscard]] bool try_take(T& value) noexcept {
    return try_swap(State::kFull, State::kEmpty, value);
  }

 private:
  enum class State : std::uint8_t { kEmpty, kFull, kBusy };

  /// Swaps where the state is `from`, which becomes `to`.
  [[nodiscard]] bool try_swap(State from, State to, T& value) noexcept {
    if (!state_.compare_exchange_strong(from, State::kBusy, std::memory_order_acq_rel,
                                        std::memory_order_relaxed)) {
      return false;
    }
    std::swap(value_, value);
    state_.store(to, std::memory_order_release);
    return true;
  }

  std::atomic<State> state_{State::kEmpty};
  static_assert(std::atomic<State>::is_always_lock_free);
  T value_{};
};

}  // namespace meridian::interpolator
