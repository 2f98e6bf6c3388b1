// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace meridian::interpolator {

/// When each of the last setpoints was sent, so that a drive's answer to one can be timed. The
/// publisher notes, the receive thread asks; neither waits. Proof:
/// tests/unit/daemon/sent_times_test.cpp.
class SentTimes {
 public:
  static constexpr std::size_t kSlots = 256;

  /// RT: publisher.
  void note(std::uint64_t cycle, std::int64_t now_ns) noexcept {
    Slot& slot = slots_[cycle % kSlots];
    slot.cycle.store(kNobody, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    slot.sent_ns.store(now_ns, std::memory_order_relaxed);
    slot.cycle.store(cycle, std::memory_order_release);
  }

  /// When the setpoint of `cycle` was sent; 0 where that is not known (any more).
  [[nodiscard]] std::int64_t sent_ns(std::uint64_t cycle) const noexcept {
    const Slot& slot = slots_[cycle % kSlots];
    if (slot.cycle.load(std::memory_order_acquire) != cycle) return 0;
    const std::int64_t sent = slot.sent_ns.load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
    return slot.cycle.load(std::memory_order_relaxed) == cycle ? sent : 0;
  }

 private:
  static constexpr std::uint64_t kNobody = UINT64_MAX;
  struct Slot {
    std::atomic<std::uint64_t> cycle{kNobody};
    std::atomic<std::int64_t> sent_ns{0};
  };
  std::array<Slot, kSlots> slots_;
};

}  // namespace meridian::interpolator
