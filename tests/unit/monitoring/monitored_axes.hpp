// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/monitoring/monitor.hpp"

namespace meridian::test {

/// Two axes without a wire and a clock: a linear one and a rotary one, 1 ms a cycle.
[[nodiscard]] inline monitoring::Limits two_axes() {
  monitoring::Limits limits;
  limits.axis_count = 2;
  limits.axes[0] = {.speed = 300,
                    .set_up_speed = 2000.0 / 60,
                    .standstill = 1,
                    .drive_speed = 300,
                    .frozen = 2,
                    .window_margin = 0.5,
                    .has_window = true,
                    .low = -100,
                    .high = 100,
                    .set_up_low = -10,
                    .set_up_high = 10};
  limits.axes[1] = {
      .speed = 1, .set_up_speed = 0.2, .standstill = 0.01, .drive_speed = 1, .frozen = 0.02};
  return limits;
}

/// A monitor that is fed with reports that come on time, unless a test changes `in`.
struct MonitoredAxes {
  explicit MonitoredAxes(const monitoring::Limits& limits = two_axes()) : monitor(limits) {
    in.has_report = true;
    in.known_mask = 0b11;
    in.cycle = 100;
  }

  /// Each axis has a drive of its own.
  monitoring::Result check() {
    in.reported = in.measured;
    return monitor.check(in);
  }
  /// One cycle with a report of its own, of the setpoint before.
  monitoring::Result cycle() {
    in.cycle += static_cast<std::uint64_t>(in.periods);
    in.cycle_seen.fill(in.cycle - 1);
    in.arrival_ns.fill(static_cast<std::int64_t>(in.cycle) * 1'000'000);
    return check();
  }
  /// Axis 0 moves with the setpoint, `speed` mm/s, its tip along; the first finding of it.
  monitoring::Result run(double seconds, double speed = 0) {
    monitoring::Result first;
    for (double t = 0; t < seconds; t += 1e-3) {
      in.commanded[0] += speed * 1e-3;
      in.measured[0] = in.commanded[0];
      in.tip[0] = in.measured[0];
      const monitoring::Result result = cycle();
      if (first.finding == monitoring::Finding::kNone) first = result;
    }
    return first;
  }

  monitoring::Inputs in;
  monitoring::Monitor monitor;
};

}  // namespace meridian::test
