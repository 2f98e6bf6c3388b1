// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "service/recording/record/flight/flight_row.hpp"

namespace meridian::telemetry {

/// A run whose cycles a test lets pass, into anything that keeps them.
struct Flown {
  std::uint64_t cycle = 0;
  std::uint16_t flags = 0;  ///< of every setpoint

  template <class Keeper>
  void cycles(Keeper& keeper, int count, State state) {
    for (int i = 0; i < count; ++i) {
      CycleRecord record;
      record.setpoint.cycle = ++cycle;
      record.setpoint.due_ns = static_cast<std::int64_t>(cycle) * 1'000'000;
      record.setpoint.flags = flags;
      record.state = state;
      record::DriveReport report;
      report.arrival_ns = record.setpoint.due_ns;
      report.cycle_seen = cycle - 1;
      report.position[0] = static_cast<double>(cycle);
      keeper.take(report);
      keeper.take(record);
    }
  }
  [[nodiscard]] Event alarm(Alarm alarm, int joint) const {
    Event event;
    event.code = EventCode::kAlarm;
    event.cycle = cycle + 1;
    event.a = static_cast<std::uint64_t>(alarm);
    event.b = static_cast<std::uint64_t>(joint);
    event.x = 2.5;
    event.line = 17;
    return event;
  }
};

}  // namespace meridian::telemetry
