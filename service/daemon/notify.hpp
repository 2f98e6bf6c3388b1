// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace meridian::interpolator {

/// Reports the state of the service to the service manager, in the protocol of sd_notify(3): a
/// datagram to the socket that the environment names. Says nothing where nobody asked. One thread.
/// Proof: tests/unit/daemon/notify_test.cpp.
class ServiceManager {
 public:
  /// Takes NOTIFY_SOCKET and WATCHDOG_USEC out of the environment.
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  void is_ready(const std::string& status) noexcept;
  void is_stopping() noexcept;
  /// Call at least ten times a second with a count that grows while the cycle runs: feeds the
  /// watchdog, at half its time, as long as it does. A cycle that hangs lets the watchdog bite.
  void beat(std::uint64_t cycles, std::chrono::steady_clock::time_point now) noexcept;

 private:
  void send(const std::string& text) const noexcept;

  int socket_ = -1;
  std::string address_;
  std::optional<std::chrono::microseconds> watchdog_;
  std::chrono::steady_clock::time_point reported_{};
  std::uint64_t cycles_ = 0;
};

}  // namespace meridian::interpolator
