// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>

/// What the kernel booked to the calling thread.
namespace meridian::watch {

struct KernelAccount {
  long minor_faults = 0;          ///< pages mapped without a disk read
  long major_faults = 0;          ///< pages read from a disk
  long voluntary_switches = 0;    ///< times that it went to sleep
  long involuntary_switches = 0;  ///< times that it was taken off its CPU
};

/// All of it since the thread began. Proof: tests/unit/support/kernel_account_test.cpp.
[[nodiscard]] inline KernelAccount kernel_account() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {usage.ru_minflt, usage.ru_majflt, usage.ru_nvcsw, usage.ru_nivcsw};
}

[[nodiscard]] inline KernelAccount operator-(const KernelAccount& end,
                                             const KernelAccount& begin) noexcept {
  return {end.minor_faults - begin.minor_faults, end.major_faults - begin.major_faults,
          end.voluntary_switches - begin.voluntary_switches,
          end.involuntary_switches - begin.involuntary_switches};
}

}  // namespace meridian::watch
