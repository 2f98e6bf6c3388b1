// SPDX-License-Identifier: Apache-2.0
#include "support/watch_slot.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace meridian::watch {
namespace {

constexpr std::size_t kSlotCount = 4096;

// Zero-initialised, so counting works in constructors that run before ours.
constinit std::array<Slot, kSlotCount> slots{};
constinit std::atomic<std::size_t> slots_taken{0};

// initial-exec: a plain offset from the thread pointer, never a lazy allocation inside malloc.
__attribute__((tls_model("initial-exec"))) constinit thread_local Slot* own_slot = nullptr;

}  // namespace

Slot& slot_of_this_thread() noexcept {
  if (own_slot == nullptr) {
    const std::size_t index = slots_taken.fetch_add(1, std::memory_order_relaxed);
    own_slot = &slots[std::min(index, kSlotCount - 1)];
    own_slot->thread_id.store(static_cast<pid_t>(syscall(SYS_gettid)), std::memory_order_release);
  }
  return *own_slot;
}

Slot* find_slot(pid_t thread_id) noexcept {
  const std::size_t taken = std::min(slots_taken.load(std::memory_order_relaxed), kSlotCount);
  for (std::size_t i = taken; i-- > 0;) {  // newest first: the kernel hands out ids again
    if (slots[i].thread_id.load(std::memory_order_acquire) == thread_id) {
      return &slots[i];
    }
  }
  return nullptr;
}

}  // namespace meridian::watch
