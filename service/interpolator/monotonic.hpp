// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ctime>

namespace meridian::interpolator {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Now on the machine's clock, ns. Not a system call (vDSO). RT: cycle.
[[nodiscard]] inline std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

}  // namespace meridian::interpolator
