// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace meridian::interpolator {

/// What intake says about the block queue.
struct QueueMark {
  std::uint64_t until = 0;  ///< of all blocks ever pushed, those before this count are void
  std::uint16_t epoch = 1;  ///< that the others are meant for
  [[nodiscard]] friend bool operator==(const QueueMark&, const QueueMark&) = default;
};

/// A QueueMark between one writer and one reader, in one atomic word: who reads it never sees the
/// count of one mark and the epoch of another. 2^48 blocks last nine years at a million a second.
class QueueMarkWord {
 public:
  void store(QueueMark mark) noexcept {
    word_.store(mark.until << kEpochBits | mark.epoch, std::memory_order_release);
  }
  [[nodiscard]] QueueMark load() const noexcept {
    const std::uint64_t word = word_.load(std::memory_order_acquire);
    return {word >> kEpochBits, static_cast<std::uint16_t>(word)};
  }

 private:
  static constexpr unsigned kEpochBits = 16;
  std::atomic<std::uint64_t> word_{1};  ///< QueueMark{}
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

}  // namespace meridian::interpolator
