// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// What the attacker can do: each mode runs for a bounded time and returns the exit code.
namespace attack {

struct Options {
  std::string mode;
  int domain = -1;
  std::string machine = "lai";
  double duration_s = 10;
  double rate_hz = 100;
  int count = 1;  ///< of participants, or of samples where 0 is no bound
  std::string topics = "all";
  std::string shape = "well";
  int verb = 255;       ///< of commands
  int max_samples = 1;  ///< of a stuck reader
  double lease_s = 1;
  std::uint64_t seed = 1;
  long service_process = 0;  ///< process of the honest service: what else speaks is a stranger
  long drives_process = 0;
  std::uint64_t operator_id = 0;  ///< 0: drawn
  std::string file;               ///< of a watch
};

/// Readers of these topics that match and never take.
int stick(const Options& options);
/// Samples at a rate, until time or count are over.
int flood(const Options& options);
/// A service that nobody started: claims the machine, commands the drives, answers operators.
int fake_service(const Options& options);
/// Drives that are none: feedback at 1 kHz, and actions answered at once.
int fake_drives(const Options& options);
/// Many participants at once, with readers and writers.
int crowd(const Options& options);
/// Participants that come and go.
int churn(const Options& options);
/// Sessions that are opened and closed.
int open_sessions(const Options& options);
/// Every setpoint on the wire, into a file (CSV), until SIGTERM: what an outsider knows of the
/// path.
int watch(const Options& options);
/// The honest operator, and who measures (operator.cpp says what it reads and prints).
int operate(const Options& options);

}  // namespace attack
