// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

namespace meridian::process {

/// The processors that this process was given when it began, and those that it took; what it starts
/// gets these again, wherever its own threads are pinned by then.
[[nodiscard]] const cpu_set_t& initial_cpus() noexcept;

/// The last of them: the service's choice for its cycle too.
[[nodiscard]] int last_cpu() noexcept;

/// Adds a processor to them that was kept from this process: one that is isolated is in nobody's
/// set by itself. False where the kernel does not let us have it. Call before threads are started.
[[nodiscard]] bool take_cpu(int cpu) noexcept;

/// Keeps the calling thread, and threads that it starts, off one CPU where there is another.
void stay_off_cpu(int cpu) noexcept;

}  // namespace meridian::process
