// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

namespace meridian::process {

/// What the kernel keeps of a process (proc(5)).
struct Account {
  double resident_mib = 0;
  int threads = 0, files = 0;
  std::uint64_t minor_faults = 0, major_faults = 0;
};
[[nodiscard]] std::optional<Account> account_of(pid_t process);

/// What it keeps of one thread of it.
struct ThreadAccount {
  std::uint64_t minor_faults = 0, major_faults = 0;
  std::uint64_t voluntary_switches = 0, involuntary_switches = 0;
};
/// By the thread's name; nothing where there is none of that name.
[[nodiscard]] std::optional<ThreadAccount> account_of(pid_t process, const std::string& thread);

}  // namespace meridian::process
