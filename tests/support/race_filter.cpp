// SPDX-License-Identifier: Apache-2.0

/// Linked into programs under the thread sanitizer: drops reports of races between two accesses
/// that both were made by a library that is not instrumented (Debian's Cyclone DDS and spdlog).
/// What such a library hands from thread to thread is ordered by atomics that the sanitizer cannot
/// see; it sees only the memcpy, free or lock in between. A report with one access of ours stands:
/// unlike a suppression, which drops every report that has the library anywhere on one of its two
/// stacks.

#include <dlfcn.h>

#include <cstddef>
#include <cstdint>

// The sanitizer's interface for debuggers, and the hook that it calls before it prints.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
int __tsan_get_report_data(void* report, const char** description, int* count, int* stack_count,
                           int* access_count, int* location_count, int* mutex_count,
                           int* thread_count, int* thread_id_count, void** sleep_trace,
                           std::uintptr_t sleep_trace_size);
int __tsan_get_report_mop(void* report, std::uintptr_t index, int* thread, void** address,
                          int* size, int* is_write, int* is_atomic, void** trace,
                          std::uintptr_t trace_size);
}
namespace __tsan {
class ReportDesc;
bool OnReport(const ReportDesc* report, bool is_suppressed);
}  // namespace __tsan
// NOLINTEND(bugprone-reserved-identifier)

// None of this may be instrumented or call what the sanitizer intercepts: it runs inside a report.
#define MERIDIAN_NOT_WATCHED __attribute__((no_sanitize("thread"), noinline))

namespace {

MERIDIAN_NOT_WATCHED bool contains(const char* text, const char* part) {
  for (; *text != '\0'; ++text) {
    std::size_t i = 0;
    while (part[i] != '\0' && text[i] == part[i]) ++i;
    if (part[i] == '\0') return true;
  }
  return false;
}

/// Whether the innermost frame outside of the sanitizer lies in a library that is not instrumented.
MERIDIAN_NOT_WATCHED bool is_of_library(void* const* trace, std::size_t size) {
  for (std::size_t i = 0; i < size && trace[i] != nullptr; ++i) {
    Dl_info symbol_info;
    if (dladdr(trace[i], &symbol_info) == 0 || symbol_info.dli_fname == nullptr) return false;
    if (contains(symbol_info.dli_fname, "libtsan.so")) continue;
    return contains(symbol_info.dli_fname, "libddsc.so") ||
           contains(symbol_info.dli_fname, "libspdlog.so");
  }
  return false;
}

}  // namespace

MERIDIAN_NOT_WATCHED bool __tsan::OnReport(const ReportDesc* report, bool is_suppressed) {
  auto* const data = const_cast<ReportDesc*>(report);
  const char* description = nullptr;
  int accesses = 0;
  int ignored[7];
  void* sleep_trace[1];
  __tsan_get_report_data(data, &description, &ignored[0], &ignored[1], &accesses, &ignored[2],
                         &ignored[3], &ignored[4], &ignored[5], sleep_trace, 1);
  if (accesses < 2) return is_suppressed;
  for (int i = 0; i < accesses; ++i) {
    void* trace[16] = {};
    void* address = nullptr;
    __tsan_get_report_mop(data, static_cast<std::uintptr_t>(i), &ignored[0], &address, &ignored[1],
                          &ignored[2], &ignored[3], trace, 16);
    if (!is_of_library(trace, 16)) return is_suppressed;
  }
  return true;
}
