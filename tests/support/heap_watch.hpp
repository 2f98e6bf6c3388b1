// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// Counts heap calls of the calling thread. A program that links heap_watch.cpp has malloc and its
/// kin interposed, operator new included; not under sanitizers, which interpose them themselves.
namespace meridian::watch {

struct HeapCalls {
  std::uint64_t allocations = 0;  ///< malloc, calloc, realloc and the aligned kinds
  std::uint64_t frees = 0;        ///< free of something; free(nullptr) costs nothing
  friend bool operator==(const HeapCalls&, const HeapCalls&) = default;
};

/// False under sanitizers: then every count reads zero and a test that needs it has to skip.
[[nodiscard]] bool is_heap_watched() noexcept;

/// All heap calls of the calling thread since it began.
[[nodiscard]] HeapCalls heap_calls() noexcept;

/// Keeps who makes the calling thread's next few heap calls.
void keep_heap_traces() noexcept;
/// Who made the first `calls` of those that were kept, one call a line.
[[nodiscard]] std::string heap_traces(HeapCalls calls);

/// Counts from its construction on. Proof: tests/unit/support/heap_watch_test.cpp.
class HeapWatch {
 public:
  HeapWatch() noexcept : begin_(heap_calls()) { keep_heap_traces(); }
  [[nodiscard]] HeapCalls calls() const noexcept {
    const HeapCalls now = heap_calls();
    return {now.allocations - begin_.allocations, now.frees - begin_.frees};
  }
  /// Who made the first of `calls`, for the message of a test that fails. Of the newest watch of
  /// the thread alone.
  [[nodiscard]] static std::string callers(HeapCalls calls) { return heap_traces(calls); }

 private:
  HeapCalls begin_;
};

}  // namespace meridian::watch
