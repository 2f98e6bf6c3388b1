// SPDX-License-Identifier: Apache-2.0
#include "support/call_trace.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <link.h>
#include <unwind.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace meridian::watch {
namespace {

/// Fills a trace from the caller of the interposed function on; the frames inside it are ours.
struct Walk {
  Trace& trace;
  const void* caller;
  std::size_t depth = 0;
};

_Unwind_Reason_Code take_frame(_Unwind_Context* context, void* argument) {
  Walk& walk = *static_cast<Walk*>(argument);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the unwinder gives addresses as integers
  const auto* const frame = reinterpret_cast<const void*>(_Unwind_GetIP(context));
  if (walk.depth == 0 && frame != walk.caller) return _URC_NO_REASON;
  walk.trace.frames[walk.depth] = frame;
  return ++walk.depth < walk.trace.frames.size() ? _URC_NO_REASON : _URC_END_OF_STACK;
}

std::string demangled(const char* symbol) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(
      abi::__cxa_demangle(symbol, nullptr, nullptr, &status), &std::free);
  return status == 0 ? name.get() : symbol;
}

/// A return address as the function that holds it, or as the file and the offset in it.
std::string frame_text(const void* frame) {
  // The call stands before the address it returns to, which may be in the next function.
  const auto* const call = static_cast<const std::byte*>(frame) - 1;
  Dl_info symbol_info{};
  const ElfW(Sym)* symbol = nullptr;
  if (dladdr1(call, &symbol_info, reinterpret_cast<void**>(const_cast<ElfW(Sym)**>(&symbol)),
              RTLD_DL_SYMENT) == 0 ||
      symbol_info.dli_fname == nullptr) {
    return "?";
  }
  // The nearest symbol of a stripped file may be that of another function.
  if (symbol != nullptr && symbol_info.dli_sname != nullptr &&
      call < static_cast<const std::byte*>(symbol_info.dli_saddr) + symbol->st_size) {
    return demangled(symbol_info.dli_sname);
  }
  char offset[32];
  std::snprintf(offset, sizeof offset, "+0x%tx",
                call - static_cast<const std::byte*>(symbol_info.dli_fbase));
  return symbol_info.dli_fname + std::string(offset);
}

}  // namespace

void keep_traces(Slot& slot) noexcept {
  slot.traces_left.store(Slot::kTraces, std::memory_order_release);
}

void trace_call(Slot& slot, const char* what, const void* caller) noexcept {
  const std::size_t left = slot.traces_left.load(std::memory_order_acquire);
  if (left == 0) return;
  Trace& trace = slot.traces[Slot::kTraces - left];
  trace = {.what = what, .frames = {caller}};
  Walk walk{.trace = trace, .caller = caller};
  (void)_Unwind_Backtrace(take_frame, &walk);
  slot.traces_left.store(left - 1, std::memory_order_release);
}

std::string traces_text(const Slot& slot, std::size_t max) {
  std::string text;
  const std::size_t left = slot.traces_left.load(std::memory_order_acquire);
  const std::size_t kept = left == 0 && slot.traces[0].what == nullptr ? 0 : Slot::kTraces - left;
  for (std::size_t i = 0; i < std::min(kept, max); ++i) {
    const Trace& trace = slot.traces[i];
    text += trace.what;
    for (const void* const frame : trace.frames) {
      if (frame == nullptr) break;
      text += " < " + frame_text(frame);
    }
    text += "\n";
  }
  return text;
}

}  // namespace meridian::watch
