// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>

#include "service/host/process/child_process.hpp"

namespace meridian::probe {

/// Somebody wants no more of the measurement.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// As ChildProcess::wait_for_exit(), but throws Interrupted as soon as `is_stopping`.
[[nodiscard]] inline std::optional<int> wait_for_exit(process::ChildProcess& child,
                                                      std::chrono::milliseconds timeout,
                                                      const std::atomic<bool>& is_stopping) {
  constexpr std::chrono::milliseconds kLook{50};
  const auto give_up = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    if (is_stopping.load()) throw Interrupted();
    if (const auto code = child.wait_for_exit(kLook)) return code;
    if (std::chrono::steady_clock::now() > give_up) return std::nullopt;
  }
}

}  // namespace meridian::probe
