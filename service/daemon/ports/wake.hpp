// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>

namespace meridian::interpolator {

/// Wakes one sleeping thread: a futex word that counts calls. notify() is one system call and never
/// blocks. A call between look() and wait() is not lost, because the word has changed by then.
/// RT: cycle (notify).
class Wake {
 public:
  void notify() noexcept {
    word_.fetch_add(1, std::memory_order_release);
    syscall(SYS_futex, &word_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
  }

  /// The word as of now: take it, look at the work, then wait() with it.
  [[nodiscard]] std::uint32_t look() const noexcept {
    return word_.load(std::memory_order_acquire);
  }

  /// Sleeps until the word differs from `seen` or `timeout_ns` have passed.
  void wait(std::uint32_t seen, std::int64_t timeout_ns) noexcept {
    const timespec timeout{.tv_sec = timeout_ns / 1'000'000'000,
                           .tv_nsec = timeout_ns % 1'000'000'000};
    syscall(SYS_futex, &word_, FUTEX_WAIT_PRIVATE, seen, &timeout, nullptr, 0);
  }

 private:
  std::atomic<std::uint32_t> word_{0};
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
  static_assert(sizeof(std::atomic<std::uint32_t>) == 4);
};

}  // namespace meridian::interpolator
