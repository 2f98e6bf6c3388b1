// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace meridian::telemetry {

/// A bounded queue of many threads that put and one that takes. Nobody ever waits: where it is full
/// try_push() says so. Each place carries a number, its turn: equal to a ticket, it is free for the
/// producer who drew that ticket; one more, its value is there for the consumer (Vyukov's bounded
/// queue). Proof: tests/unit/telemetry/audit_log_test.cpp.
template <class T, std::size_t N>
class AuditQueue {
  static_assert((N & (N - 1)) == 0, "a power of two, so that tickets may wrap");

 public:
  AuditQueue() noexcept {
    for (std::size_t i = 0; i < N; ++i) slots_[i].turn.store(i, std::memory_order_relaxed);
  }

  /// Any thread. False, and `value` stays as it was, where there is no room.
  [[nodiscard]] bool try_push(T&& value) noexcept {
    std::uint64_t ticket = next_.load(std::memory_order_relaxed);
    for (;;) {
      Slot& slot = slots_[ticket % N];
      const std::uint64_t turn = slot.turn.load(std::memory_order_acquire);
      if (turn < ticket) return false;
      if (turn == ticket &&
          next_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_relaxed)) {
        slot.value = std::move(value);
        slot.turn.store(ticket + 1, std::memory_order_release);
        return true;
      }
      if (turn != ticket) ticket = next_.load(std::memory_order_relaxed);
    }
  }

  /// The consumer's thread alone.
  [[nodiscard]] bool try_pop(T& value) noexcept {
    Slot& slot = slots_[taken_ % N];
    if (slot.turn.load(std::memory_order_acquire) != taken_ + 1) return false;
    value = std::exchange(slot.value, T());
    slot.turn.store(taken_ + N, std::memory_order_release);
    ++taken_;
    return true;
  }

 private:
  struct Slot {
    std::atomic<std::uint64_t> turn{0};
    T value{};
  };
  std::array<Slot, N> slots_;
  alignas(64) std::atomic<std::uint64_t> next_{0};
  alignas(64) std::uint64_t taken_ = 0;
};

}  // namespace meridian::telemetry
