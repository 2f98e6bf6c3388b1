// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Counts the locks that the calling thread takes: mutexes, read-write locks and condition waits of
/// the C library, interposed where lock_watch.cpp is linked (not under the thread sanitizer).
namespace meridian::watch {

struct LockCalls {
  std::uint64_t locks = 0;            ///< taken, tried, or waited for
  std::uint64_t contended_locks = 0;  ///< those of them that somebody else held
};

/// False under the thread sanitizer: then every count reads zero.
[[nodiscard]] bool is_lock_watched() noexcept;

/// All locks of the calling thread since it began.
[[nodiscard]] LockCalls lock_calls() noexcept;

/// Counts from its construction on. Proof: tests/unit/support/lock_watch_test.cpp.
class LockWatch {
 public:
  LockWatch() noexcept : begin_(lock_calls()) {}
  [[nodiscard]] LockCalls calls() const noexcept {
    const LockCalls now = lock_calls();
    return {now.locks - begin_.locks, now.contended_locks - begin_.contended_locks};
  }

 private:
  LockCalls begin_;
};

}  // namespace meridian::watch
