// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace meridian::probe {

struct BarePeerOptions {
  int cpu = 0;
  std::uint32_t domain = 0;
  std::int64_t period_ns = 1'000'000;
  std::string partition;
  int priority = 80;  ///< FIFO, of its one thread
};

/// What the service is compared with, the body of a process of its own. One thread, of the
/// priority and pinned as the service's cycle (where the rights are there), that does nothing but
/// sleep to start + n * period, and on request write a sample of the setpoint's size and quality of
/// service with nothing in between. Commands on standard input, one a line, each answered by one
/// line:
///
///     wake N   wakes N times: the N latenesses, ns
///     ping N   wakes N times and writes each time: N times "cycle:written_at_ns:round_trip_ns",
///              the last 0 where nobody answered
///
/// In front of each answer stands how many of the wakes were not on that CPU.
/// Warm-up is the caller's to drop. Returns at the end of the input.
void run_bare_peer(const BarePeerOptions& options);

}  // namespace meridian::probe
