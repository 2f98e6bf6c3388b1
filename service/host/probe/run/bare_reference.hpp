// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "service/host/probe/run/drive_side.hpp"
#include "service/host/probe/turn_figures.hpp"
#include "service/host/process/child_process.hpp"

namespace meridian::probe {

/// Dropped at the start of every turn, the service's and the bare thread's alike; then a turn's
/// length.
inline constexpr std::int64_t kWarmUp_ns = 100'000'000, kTurn_ns = 1'000'000'000;

/// The bare thread and the bare ping in a process of their own (bare_peer.hpp), which is the tool
/// `meridian` beside the running program. Not running between turns.
class BareReference {
 public:
  /// Throws std::runtime_error where the process does not come up.
  BareReference(int cpu, std::uint32_t domain, std::int64_t period_ns, int priority = 80);

  /// One turn of the bare thread: its latenesses, ns. Throws where it, or the ping, was not on that
  /// CPU: it would be compared with another.
  [[nodiscard]] std::vector<std::int64_t> wake_turn();
  /// One turn of pings, ns: written until seen by the drive process, and until its answer was back.
  struct Pings {
    std::vector<std::int64_t> one_way_ns, round_trip_ns;
    Missing unseen;  ///< never came to the drive process
  };
  [[nodiscard]] Pings ping_turn();

 private:
  [[nodiscard]] std::string ask(const std::string& verb);

  int cpu_;
  std::size_t warm_up_, periods_;  ///< of a turn
  DriveSide drive_side_;
  process::ChildProcess process_;
};

}  // namespace meridian::probe
