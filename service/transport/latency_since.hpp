// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "service/transport/convert/messages.hpp"

namespace meridian::dds {

/// What was counted from `begin` to `end`, two snapshots of one service. A service that was started
/// anew in between began to count anew: of it, all that `end` has.
[[nodiscard]] inline Latency latency_since(const Latency& begin, Latency end) {
  if (begin.service_id != end.service_id) return end;
  for (std::size_t i = 0; i < end.histograms.size() && i < begin.histograms.size(); ++i) {
    end.histograms[i].histogram = end.histograms[i].histogram.since(begin.histograms[i].histogram);
  }
  return end;
}

}  // namespace meridian::dds
