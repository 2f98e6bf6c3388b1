// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace meridian::interpolator {

/// A program and a change of the set-up keep each other out: whoever holds this has begun, the
/// other one is refused. Both sides ask once and wait for nobody.
///
/// Memory order. Whoever comes after sees what the holder before did: give_back() releases,
/// try_take() acquires. So a session that is opened after a change finds the new frame.
/// Proof: tests/unit/daemon/program_claim_test.cpp.
class ProgramClaim {
 public:
  enum class Holder : std::uint8_t { kNobody, kSession, kSetUp };

  /// Any thread: whether `holder` holds it now; it may do so already.
  [[nodiscard]] bool try_take(Holder holder) noexcept {
    Holder before = Holder::kNobody;
    return holder_.compare_exchange_strong(before, holder, std::memory_order_acq_rel,
                                           std::memory_order_acquire) ||
           before == holder;
  }
  /// Its holder; of anybody else nothing happens.
  void give_back(Holder holder) noexcept {
    (void)holder_.compare_exchange_strong(holder, Holder::kNobody, std::memory_order_release,
                                          std::memory_order_relaxed);
  }

 private:
  std::atomic<Holder> holder_{Holder::kNobody};
  static_assert(std::atomic<Holder>::is_always_lock_free);
};

}  // namespace meridian::interpolator
