// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "meridian/cycle/histogram.hpp"

namespace meridian::probe {

/// The histogram that `cyclictest -h` prints ("000012 000345": µs, how many; overflows at the end).
/// Nothing where there is none. Proof: tests/unit/probe/probe_report_test.cpp.
[[nodiscard]] std::optional<Histogram> parse_cyclictest(const std::string& text);

/// Latencies by cyclictest of Debian's rt-tests, one thread at FIFO 80 on `cpu`; nothing where it
/// is not installed or has no right to run so. Throws Interrupted.
[[nodiscard]] std::optional<Histogram> run_cyclictest(int cpu, std::int64_t period_ns,
                                                      double seconds,
                                                      const std::atomic<bool>& is_stopping);

}  // namespace meridian::probe
