// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/processors.hpp"

namespace meridian::process {
namespace {

[[nodiscard]] cpu_set_t current_cpus() noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  return set;
}

/// Taken before main() begins and anybody pins anything.
cpu_set_t initial = current_cpus();

}  // namespace

const cpu_set_t& initial_cpus() noexcept { return initial; }

int last_cpu() noexcept {
  int last = 0;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &initial)) last = i;
  }
  return last;
}

bool take_cpu(int cpu) noexcept {
  if (cpu < 0 || cpu >= CPU_SETSIZE) return false;
  if (CPU_ISSET(cpu, &initial)) return true;
  const cpu_set_t before = current_cpus();
  cpu_set_t wider = initial;
  CPU_SET(cpu, &wider);
  if (sched_setaffinity(0, sizeof wider, &wider) != 0) return false;
  const cpu_set_t granted = current_cpus();  // the kernel leaves out what we may not have
  sched_setaffinity(0, sizeof before, &before);
  if (!CPU_ISSET(cpu, &granted)) return false;
  initial = wider;
  return true;
}

void stay_off_cpu(int cpu) noexcept {
  cpu_set_t set = current_cpus();
  CPU_CLR(cpu, &set);
  if (CPU_COUNT(&set) > 0) sched_setaffinity(0, sizeof set, &set);
}

}  // namespace meridian::process
