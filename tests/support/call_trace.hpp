// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "support/watch_slot.hpp"

/// Who made the heap calls that a watch counted.
namespace meridian::watch {

/// Keeps the next Slot::kTraces heap calls of that slot's thread; what was kept before is dropped.
/// Any thread may ask.
void keep_traces(Slot& slot) noexcept;

/// Keeps a call where there is room. The thread of the slot calls this from inside the interposed
/// function `what`, whose caller is at `caller`. No heap call.
void trace_call(Slot& slot, const char* what, const void* caller) noexcept;

/// The kept calls, at most so many, one a line: function and its callers, innermost first. An
/// address that no dynamic symbol covers reads FILE+OFFSET: `addr2line -Cfe FILE OFFSET`.
[[nodiscard]] std::string traces_text(const Slot& slot, std::size_t max = Slot::kTraces);

}  // namespace meridian::watch
