// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "integration/fault_part.hpp"
#include "integration/hosts.hpp"

namespace meridian::test {

/// Something that goes wrong between real processes, and what comes of it: letters as in the table
/// of docs/faults.md, several where any of them may, "–" where there is no such pair.
struct LiveFault {
  enum class How {
    kConsole,       ///< a line that `meridian drives --console` reads
    kStationDies,   ///< SIGKILL
    kStationStops,  ///< SIGSTOP for a while
    kServiceDies,   ///< SIGKILL
    kDrivesDie,     ///< SIGKILL
    kStall,         ///< SIGSTOP of the service for `milliseconds`
    kSetUp,         ///< operators change the set-up; where a program is, all of them are refused
    kRubbish,       ///< somebody sends what nobody asked for on every topic that moves machines
    kAttacker,      ///< `line` is the command line of tests/attack's attacker
    kStuck,         ///< the same, and it is stopped (SIGSTOP) as soon as it is there
    kBlockedLog,    ///< the same, and the service's log is a pipe that nobody reads
    kRecoveryDies,  ///< as kServiceDies, and the next services too, as soon as they move
    kWire           ///< between hosts
  };
  const char* name;
  How how;
  const char* line;     ///< for the console
  const char* moving;   ///< what comes of it while the machine moves or goes on by itself
  const char* resting;  ///< while it waits for somebody
  int milliseconds = 0;
  Hosts::Spoilt wire{};
  int times = 1;  ///< that the line is typed into the console

  [[nodiscard]] bool is_of_station() const noexcept {
    return how == How::kStationDies || how == How::kStationStops;
  }
};

/// Whether MERIDIAN_FAULT_MATRIX=all is in the environment.
[[nodiscard]] bool is_whole_matrix();

[[nodiscard]] std::span<const Phase> phases();
[[nodiscard]] std::span<const LiveFault> live_faults();

[[nodiscard]] std::string expected(const LiveFault& fault, const Phase& phase);
/// What is expected of every pair, as in docs/faults.md.
[[nodiscard]] std::string table_of_faults();

}  // namespace meridian::test
