// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Programs of ours that run beside a test, what they read and where they print.
namespace meridian::test {

using std::chrono::milliseconds;

/// Asks `condition` again and again; false where it did not come true in time.
[[nodiscard]] bool eventually(const std::function<bool()>& condition,
                              milliseconds patience = milliseconds(5000));

/// A pipe that the test writes and a process reads as its standard input.
class InputPipe {
 public:
  InputPipe();
  ~InputPipe();
  InputPipe(const InputPipe&) = delete;
  InputPipe& operator=(const InputPipe&) = delete;

  void write(const std::string& text) const;
  /// What the reader sees as the end of its input.
  void close();
  [[nodiscard]] int read_end() const noexcept { return read_end_; }

 private:
  int read_end_ = -1, write_end_ = -1;
};

/// A pseudo-terminal that a process has as its standard output.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Everything that was printed so far.
  [[nodiscard]] const std::string& shown();
  [[nodiscard]] int process_end() const noexcept { return process_end_; }

 private:
  int our_end_ = -1, process_end_ = -1;
  std::string shown_;
};

/// A host that a program may run on instead of the test's (hosts.hpp).
struct HostEnvironment {
  std::string network;      ///< file of its network namespace
  std::string dds;          ///< CYCLONEDDS_URI there; empty: as for the test
  long uptime_ahead_s = 0;  ///< of its monotonic clock; not 0 only where set_uptime_ahead() works
};

/// Sets the monotonic clock of the program that the calling process becomes next. False: this
/// kernel lends it none of its own.
[[nodiscard]] bool set_uptime_ahead(long seconds);

/// A program of ours that runs beside the test; killed with it.
class Process {
 public:
  /// Where a program with that command line runs; nullptr: beside the test. None: all do. One that
  /// cannot go there ends with exit code 126.
  static inline std::function<const HostEnvironment*(const std::vector<std::string>&)> host_of;

  /// Starts build/bin/`arguments[0]`; what it says goes to `log`, its standard output to `terminal`
  /// where one is given. It reads `input` where one is given, else what the test reads.
  Process(const std::vector<std::string>& arguments, std::filesystem::path log,
          const InputPipe* input = nullptr, const Terminal* terminal = nullptr);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send_signal(int signal) const;
  /// Exit code, or nothing where it still runs after `patience`. A death by signal is 128 + signal.
  [[nodiscard]] std::optional<int> wait(milliseconds patience);
  [[nodiscard]] std::string said() const;
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }

 private:
  pid_t pid_ = -1;
  std::filesystem::path log_;
  std::optional<int> exit_code_;
};

}  // namespace meridian::test
