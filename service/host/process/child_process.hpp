// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace meridian::process {

/// A program with pipes to its standard input and output; standard error is our own, or a file. It
/// dies with the thread that started it. Proof: tests/unit/process/child_process_test.cpp.
class ChildProcess {
 public:
  struct Options {
    std::vector<std::string> environment{};  ///< NAME=VALUE, added to our own
    std::string error_file{};                ///< where standard error goes; empty: where ours does
    std::string output_file{};               ///< where standard output goes; empty: read_line()
    bool has_own_group = false;              ///< Ctrl-C of the terminal is ours alone, not its
  };

  /// Starts `arguments`, the program's path first. Throws std::runtime_error where it cannot be.
  explicit ChildProcess(const std::vector<std::string>& arguments, const Options& options);
  explicit ChildProcess(const std::vector<std::string>& arguments)
      : ChildProcess(arguments, Options{}) {}
  /// Kills it where it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes the line with a line end.
  void write_line(const std::string& line) const;
  /// The next line without its end; nothing at the end of the output or after the timeout.
  [[nodiscard]] std::optional<std::string> read_line(std::chrono::milliseconds timeout);
  /// Closes its standard input: most programs end then.
  void close_input();

  void send_signal(int signal) const;
  /// Its exit code, 128 + signal where one ended it, nothing where it still runs after the timeout.
  std::optional<int> wait_for_exit(std::chrono::milliseconds timeout);
  [[nodiscard]] pid_t id() const { return id_; }

 private:
  pid_t id_ = -1;
  int to_ = -1, from_ = -1;
  std::string pending_;
  std::optional<int> exit_code_;
};

}  // namespace meridian::process
