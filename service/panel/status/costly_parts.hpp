// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "service/panel/serve/server.hpp"

namespace meridian::panel {

/// Answers that cost the host memory or time, one at a time: who asks meanwhile has to ask
/// again (503). Any thread. Proof: tests/panel/costly_parts_test.cpp.
class CostlyParts {
 public:
  using Clock = std::chrono::steady_clock;
  /// How long what was found on the host is true enough.
  static constexpr std::chrono::seconds kFresh{10};

  explicit CostlyParts(std::function<std::string()> examine_host)
      : examine_host_(std::move(examine_host)) {}

  /// What `make` gives; nothing: it has nothing. 503 while another answer is made.
  [[nodiscard]] std::optional<HttpAnswer> one_at_a_time(
      const std::function<std::optional<HttpAnswer>()>& make);
  /// What is found on the host, at most kFresh old at `now`; nothing where nobody examines it.
  [[nodiscard]] std::optional<HttpAnswer> host_findings(Clock::time_point now);

 private:
  std::function<std::string()> examine_host_;
  std::mutex mutex_;
  std::string findings_;
  Clock::time_point found_{};
};

}  // namespace meridian::panel
