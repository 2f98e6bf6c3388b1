// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>

namespace meridian::interpolator {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Now on the machine's clock, ns. Not a system call (vDSO). RT: cycle.
[[nodiscard]] inline std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

/// A duration in 32 bits; beyond ±2.1 s it stays there. RT: cycle.
[[nodiscard]] inline std::int32_t narrow_ns(std::int64_t ns) noexcept {
  using Limits = std::numeric_limits<std::int32_t>;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(ns, Limits::min(), Limits::max()));
}

}  // namespace meridian::interpolator
