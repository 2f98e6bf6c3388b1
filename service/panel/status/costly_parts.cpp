// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/costly_parts.hpp"

namespace meridian::panel {

std::optional<HttpAnswer> CostlyParts::one_at_a_time(
    const std::function<std::optional<HttpAnswer>()>& make) {
  constexpr int kBusy = 503;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return HttpAnswer{.status = kBusy, .text = "ask again in a moment"};
  return make();
}

std::optional<HttpAnswer> CostlyParts::host_findings(Clock::time_point now) {
  if (!examine_host_) return std::nullopt;
  return one_at_a_time([&]() -> std::optional<HttpAnswer> {
    if (findings_.empty() || now - found_ > kFresh) {
      findings_ = examine_host_();
      found_ = now;
    }
    return HttpAnswer{.type = "application/json", .text = findings_};
  });
}

}  // namespace meridian::panel
