// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// The options of every subcommand that talks to a service.
struct PeerOptions {
  std::uint32_t domain = 0;
  std::string machine;  ///< DDS partition; empty: the only machine in the domain
  double timeout_s = 5;

  [[nodiscard]] std::chrono::milliseconds timeout() const {
    return std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1e3));
  }
};

/// Adds --domain, --machine-name and --timeout to `command`.
void add_peer_options(CLI::App& command, PeerOptions& options);

/// Returns the machine that `options` mean and settles `options.machine`. Where there is none or
/// more than one it prints what to do, leaves the exit code and returns nothing.
[[nodiscard]] std::optional<dds::MachineInfo> find_machine(PeerOptions& options, int& exit_code);

/// Set by SIGINT and SIGTERM once watch_for_stop() was called.
[[nodiscard]] std::atomic<bool>& stop_flag() noexcept;
void watch_for_stop();

/// A command that has started other programs ends them in order, though nobody reads what it prints
/// any more (`| head`).
void outlive_readers();

}  // namespace meridian::cli
