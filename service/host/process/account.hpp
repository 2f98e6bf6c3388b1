// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meridian::process {

/// What the kernel keeps of a process (proc(5)).
/// Proof: tests/unit/process/account_test.cpp.
struct Account {
  double resident_mib = 0, locked_mib = 0;
  int threads = 0, files = 0;
  std::uint64_t minor_faults = 0, major_faults = 0;
};
[[nodiscard]] std::optional<Account> account_of(pid_t process);

/// What it keeps of one thread of it.
struct ThreadAccount {
  std::string name{}, processors{};  ///< where it may run, as "0-2,5"
  pid_t id = 0;
  int policy = 0, priority = 0;  ///< sched(7): SCHED_FIFO and its kin, whose priority is above 0
  std::uint64_t minor_faults = 0, major_faults = 0;
  std::uint64_t voluntary_switches = 0, involuntary_switches = 0;
};
/// Of all threads of a process; empty where there is none.
[[nodiscard]] std::vector<ThreadAccount> threads_of(pid_t process);

/// "FIFO 80", "RR 5", "normal".
[[nodiscard]] std::string scheduling_text(const ThreadAccount& thread);

}  // namespace meridian::process
