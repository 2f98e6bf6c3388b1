// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "service/transport/convert/messages.hpp"

namespace meridian::panel {

/// What GET /metrics answers, in the Prometheus text format: what status and latency topic say, in
/// base units (seconds, metres per second, ratios). `status` nothing: the service is silent, which
/// `meridian_up` says. Proof: tests/panel/metrics_test.cpp (promtool, where it is there).
[[nodiscard]] std::string metrics_text(const dds::MachineInfo& machine,
                                       const std::optional<dds::Status>& status,
                                       const std::optional<dds::Latency>& latency);

}  // namespace meridian::panel
