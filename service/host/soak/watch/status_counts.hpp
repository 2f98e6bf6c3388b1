// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/host/soak/report/soak_report.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::soak {

/// Sums over all lives of a service what the status counts from the start of each.
class StatusCounts {
 public:
  void add(const dds::Status& status, SoakReport& report) noexcept {
    if (status.service_id != before_.service_id) before_ = {.service_id = status.service_id};
    grow(report.cycles_run, before_.cycles, status.cycles_run);
    grow(report.periods_lost, before_.lost, status.periods_lost);
    grow(report.starvations, before_.starvations, status.starvations);
    grow(report.overruns, before_.overruns, status.setpoints_overrun + status.events_overrun);
  }

 private:
  struct Before {
    std::uint64_t service_id = 0, cycles = 0, lost = 0, starvations = 0, overruns = 0;
  };
  static void grow(std::uint64_t& sum, std::uint64_t& before, std::uint64_t now) noexcept {
    if (now > before) sum += now - before;
    before = now;
  }

  Before before_;
};

}  // namespace meridian::soak
