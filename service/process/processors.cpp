// SPDX-License-Identifier: Apache-2.0
#include "service/process/processors.hpp"

namespace meridian::process {
namespace {

[[nodiscard]] cpu_set_t current_cpus() noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  return set;
}

/// Taken before main() begins and anybody pins anything.
const cpu_set_t kInitial = current_cpus();

}  // namespace

const cpu_set_t& initial_cpus() noexcept { return kInitial; }

int last_cpu() noexcept {
  int last = 0;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &kInitial)) last = i;
  }
  return last;
}

void stay_off_cpu(int cpu) noexcept {
  cpu_set_t set = current_cpus();
  CPU_CLR(cpu, &set);
  if (CPU_COUNT(&set) > 0) sched_setaffinity(0, sizeof set, &set);
}

}  // namespace meridian::process
