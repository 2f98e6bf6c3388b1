// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace meridian::test {

/// CPU time of this thread, s.
[[nodiscard]] inline double cpu_s() noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace meridian::test
