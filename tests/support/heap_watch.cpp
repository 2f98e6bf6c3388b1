// SPDX-License-Identifier: Apache-2.0
#include "support/heap_watch.hpp"

#include <malloc.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include "support/call_trace.hpp"
#include "support/watch_slot.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MERIDIAN_HEAP_WATCHED 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MERIDIAN_HEAP_WATCHED 0
#endif
#endif
#ifndef MERIDIAN_HEAP_WATCHED
#define MERIDIAN_HEAP_WATCHED 1
#endif

namespace meridian::watch {

bool is_heap_watched() noexcept { return MERIDIAN_HEAP_WATCHED != 0; }

HeapCalls heap_calls() noexcept {
  const Slot& slot = slot_of_this_thread();
  return {slot.allocations.load(std::memory_order_relaxed),
          slot.frees.load(std::memory_order_relaxed)};
}

void keep_heap_traces() noexcept { keep_traces(slot_of_this_thread()); }

std::string heap_traces(HeapCalls calls) {
  return traces_text(slot_of_this_thread(), calls.allocations + calls.frees);
}

}  // namespace meridian::watch

#if MERIDIAN_HEAP_WATCHED

// glibc's own entry points behind the public names; they need no look-up, so counting works from
// the first allocation of the process on.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace {
void count_allocation(const char* what, const void* caller) noexcept {
  auto& slot = meridian::watch::slot_of_this_thread();
  meridian::watch::count(slot.allocations);
  meridian::watch::trace_call(slot, what, caller);
}
}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  count_allocation("malloc", __builtin_return_address(0));
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  count_allocation("calloc", __builtin_return_address(0));
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  count_allocation("realloc", __builtin_return_address(0));
  return __libc_realloc(block, size);
}

void* reallocarray(void* block, std::size_t count, std::size_t size) noexcept {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(count, size, &bytes)) {
    errno = ENOMEM;
    return nullptr;
  }
  return realloc(block, bytes);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count_allocation("memalign", __builtin_return_address(0));
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) {
    return EINVAL;
  }
  void* const got = memalign(alignment, size);
  if (got == nullptr) {
    return ENOMEM;
  }
  *block = got;
  return 0;
}

void* valloc(std::size_t size) noexcept {
  return memalign(static_cast<std::size_t>(sysconf(_SC_PAGESIZE)), size);
}

void free(void* block) noexcept {
  if (block == nullptr) {
    return;
  }
  auto& slot = meridian::watch::slot_of_this_thread();
  meridian::watch::count(slot.frees);
  meridian::watch::trace_call(slot, "free", __builtin_return_address(0));
  __libc_free(block);
}

}  // extern "C"

#endif  // MERIDIAN_HEAP_WATCHED
