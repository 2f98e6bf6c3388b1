// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <type_traits>

namespace meridian {

/// Distance that keeps two atomics out of one another's cache line.
inline constexpr std::size_t kCacheLine_bytes = 64;

/// Ring of `N` values between one producer thread and one consumer thread, where every item
/// matters. Wait-free on both sides, no allocation; a full ring refuses, it never overwrites.
///
/// A window of items is published whole: stage() writes items that the consumer cannot see yet,
/// publish() shows all of them with one store.
///
/// Memory order. `written_` and `read_` count items ever published and ever dropped; each is stored
/// by one side only, so a side reads its own counter relaxed. (1) The producer writes slots and
/// then stores `written_` with release; the consumer loads it with acquire before it reads a slot:
/// it sees the slot as written. (2) The consumer reads slots and then stores `read_` with release;
/// the producer loads it with acquire before it reuses a slot: the old value has been read before
/// the new one is written. (3) A slot belongs to the consumer while its count lies in [read_,
/// written_) and to the producer otherwise, so no slot is accessed by both without (1) or (2)
/// between. The copies `seen_read_` and `seen_written_` are private to one side; being old they
/// only understate what is free or filled.
///
/// RT: cycle. Proof: tests/unit/cycle/spsc_ring_test.cpp, with broken twins that fail the same
/// test.
template <class T, std::size_t N>
class SpscRing {
  static_assert(N >= 2 && (N & (N - 1)) == 0, "the capacity is a power of two");
  static_assert(std::is_trivially_copyable_v<T>, "rings carry plain data");
  static_assert(std::atomic<std::size_t>::is_always_lock_free);

 public:
  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return N; }

  /// Producer: appends and publishes one item, together with all that was staged before; false and
  /// nothing changed if there is no room.
  [[nodiscard]] bool try_push(const T& item) noexcept {
    if (!stage(item)) return false;
    publish();
    return true;
  }

  /// Producer: writes one item behind those staged before, unseen by the consumer; false if full.
  [[nodiscard]] bool stage(const T& item) noexcept {
    if (free_slots() == 0) return false;
    slots_[staged_ & (N - 1)] = item;
    ++staged_;
    return true;
  }

  /// Producer: shows all staged items to the consumer at once.
  void publish() noexcept { written_.store(staged_, std::memory_order_release); }

  /// Producer: forgets what was staged and not published.
  void discard_staged() noexcept { staged_ = written_.load(std::memory_order_relaxed); }

  /// Producer: how many more items stage() will take now. The consumer can only raise it.
  [[nodiscard]] std::size_t free_slots() noexcept {
    if (staged_ - seen_read_ == N) seen_read_ = read_.load(std::memory_order_acquire);
    return N - (staged_ - seen_read_);
  }

  /// Producer: as free_slots(), but asks the consumer's counter even where the last answer would
  /// do; use it to check whether a whole window fits.
  [[nodiscard]] std::size_t count_free_slots() noexcept {
    seen_read_ = read_.load(std::memory_order_acquire);
    return N - (staged_ - seen_read_);
  }

  /// Consumer: takes the oldest item; false if there is none.
  [[nodiscard]] bool try_pop(T& item) noexcept {
    const T* oldest = peek(0);
    if (oldest == nullptr) return false;
    item = *oldest;
    drop(1);
    return true;
  }

  /// Consumer: the item that is `i` places behind the oldest, or nullptr if it is not there yet.
  /// Valid until it is dropped or popped.
  [[nodiscard]] const T* peek(std::size_t i) noexcept {
    const std::size_t first = read_.load(std::memory_order_relaxed);
    if (seen_written_ - first <= i) seen_written_ = written_.load(std::memory_order_acquire);
    return seen_written_ - first > i ? &slots_[(first + i) & (N - 1)] : nullptr;
  }

  /// Consumer: gives the `n` oldest items back to the producer. Precondition: peek(n - 1) was
  /// there.
  void drop(std::size_t n) noexcept {
    read_.store(read_.load(std::memory_order_relaxed) + n, std::memory_order_release);
  }

  /// Items published and not yet dropped. Exact for the consumer at the instant of the call, a
  /// lower bound afterwards; for any other thread a snapshot that may be out by what both sides
  /// just did.
  [[nodiscard]] std::size_t size() const noexcept {
    const std::size_t first = read_.load(std::memory_order_acquire);
    const std::size_t last = written_.load(std::memory_order_acquire);
    return last - first <= N ? last - first : N;
  }

  [[nodiscard]] bool empty() const noexcept { return size() == 0; }

 private:
  alignas(kCacheLine_bytes) std::atomic<std::size_t> written_{0};
  alignas(kCacheLine_bytes) std::size_t staged_ = 0;  ///< producer's: written and not yet shown
  std::size_t seen_read_ = 0;                         ///< producer's copy of read_
  alignas(kCacheLine_bytes) std::atomic<std::size_t> read_{0};
  alignas(kCacheLine_bytes) std::size_t seen_written_ = 0;  ///< consumer's copy of written_
  alignas(kCacheLine_bytes) std::array<T, N> slots_{};
};

}  // namespace meridian
