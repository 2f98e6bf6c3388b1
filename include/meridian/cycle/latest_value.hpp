// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "meridian/cycle/spsc_ring.hpp"

namespace meridian {

/// The newest value between one writer thread and one reader thread; older values are overwritten.
/// Wait-free on both sides, no allocation, never torn (a triple buffer).
///
/// Memory order. Three slots: one is the writer's, one the reader's, one lies in the middle, and
/// `middle_` names it, with a mark if the writer put it there last. A side gives its slot away and
/// takes the middle one in a single exchange, so at any time each slot has exactly one owner. The
/// exchange is acq_rel: its release half makes what the giver did to the slot (write it, or finish
/// reading it) happen before whatever the taker does to it after the acquire half. The relaxed look
/// at the mark before an exchange decides only whether there is something new; it passes no data.
///
/// RT: cycle. Proof: tests/unit/cycle/latest_value_test.cpp, with a broken twin that fails it.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>, "ports carry plain data");
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

 public:
  LatestValue() = default;
  explicit LatestValue(const T& initial) noexcept : slots_{{{initial}, {initial}, {initial}}} {}

  /// Writer: makes `value` the newest.
  void store(const T& value) noexcept {
    slots_[back_].value = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Reader: true if a value was stored since the last refresh(); it is then what latest() returns.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  /// Reader: the value of the last refresh(), or the initial one. Valid until the next refresh().
  [[nodiscard]] const T& latest() const noexcept { return slots_[front_].value; }

  /// Reader: refreshes and copies; true if the copy is newer than the last one.
  bool load(T& value) noexcept {
    const bool is_new = refresh();
    value = latest();
    return is_new;
  }

 private:
  static constexpr std::uint32_t kFresh = 4, kIndex = 3;
  struct alignas(kCacheLine_bytes) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  alignas(kCacheLine_bytes) std::atomic<std::uint32_t> middle_{1};
  alignas(kCacheLine_bytes) std::uint32_t back_ = 0;   ///< writer's slot
  alignas(kCacheLine_bytes) std::uint32_t front_ = 2;  ///< reader's slot
};

}  // namespace meridian
