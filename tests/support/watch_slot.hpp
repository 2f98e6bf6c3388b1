// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

/// One set of counters per thread, written by that thread alone and readable by any. The interposed
/// functions of heap_watch.cpp and lock_watch.cpp count here; it works before main() and allocates
/// nothing.
namespace meridian::watch {

/// One call of a counted function: its name and the return addresses, innermost first.
struct Trace {
  const char* what = nullptr;
  std::array<const void*, 24> frames{};
};

struct Slot {
  static constexpr std::size_t kTraces = 4;

  std::atomic<pid_t> thread_id{0};
  std::atomic<std::uint64_t> allocations{0};      ///< malloc, calloc, realloc, aligned kinds
  std::atomic<std::uint64_t> frees{0};            ///< free of something
  std::atomic<std::uint64_t> locks{0};            ///< mutex, read-write lock, condition wait
  std::atomic<std::uint64_t> contended_locks{0};  ///< those of `locks` that had to wait
  std::atomic<std::size_t> traces_left{0};        ///< room in `traces`; see call_trace.hpp
  std::array<Trace, kTraces> traces{};            ///< the first heap calls since room was made
};

/// The calling thread's counters; claims a slot at the first call. Threads beyond kSlotCount share
/// the last slot.
[[nodiscard]] Slot& slot_of_this_thread() noexcept;

/// The newest slot of a thread, or null where it never called anything that is counted.
[[nodiscard]] Slot* find_slot(pid_t thread_id) noexcept;

inline void count(std::atomic<std::uint64_t>& counter) noexcept {
  // One writer: no read-modify-write needed, and the reader only wants an untorn value.
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace meridian::watch
