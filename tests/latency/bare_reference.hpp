// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "latency/drive_side.hpp"
#include "support/child_process.hpp"

namespace meridian::latency {

/// Periods dropped at the start of every turn, the service's and the bare thread's alike.
inline constexpr std::size_t kWarmUpPeriods = 100;
inline constexpr std::size_t kTurnPeriods = 1000;

/// The bare thread and the bare ping in a process of their own (bare_peer.cpp). Not running between
/// turns.
class BareReference {
 public:
  /// Throws std::runtime_error where the process does not come up.
  BareReference(int cpu, std::uint32_t domain, std::int64_t period_ns);

  /// One turn of the bare thread: its latenesses, ns.
  [[nodiscard]] std::vector<std::int64_t> wake_turn();
  /// One turn of pings: written until seen by the drive process, ns; lost ones are missing.
  [[nodiscard]] std::vector<std::int64_t> ping_turn();

 private:
  [[nodiscard]] std::string ask(const std::string& verb);

  DriveSide drive_side_;
  support::ChildProcess process_;
};

}  // namespace meridian::latency
