// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

#include "service/daemon/monitoring/cycle_monitor.hpp"
#include "support/machines.hpp"

namespace meridian::bench {

/// What the monitoring costs a cycle beside step(): a program of the Lai machine that runs, and
/// what is on by default; `is_all`: a jog with an open guard, the tip's speed and the models of the
/// drives too.
inline std::uint64_t run_monitoring(int count, bool is_all) {
  const MachineModel machine = test::lai_machine();
  monitoring::Limits limits;
  limits.axis_count = 5;
  for (monitoring::AxisLimits& axis : limits.axes) {
    axis = {.speed = 1e3,
            .set_up_speed = 1e3,
            .standstill = 1e3,
            .drive_speed = 1e3,
            .frozen = 1e3,
            .window_margin = 1e3,
            .has_window = true,
            .low = -1e6,
            .high = 1e6,
            .set_up_low = -1e6,
            .set_up_high = 1e6,
            .has_model = is_all,
            .time_constant_s = 0.01,
            .model_error = 1e3};
  }
  limits.set_up_tip_speed = 1e6;
  interpolator::CycleMonitor monitor(limits, 0.1);
  CycleInputs in;
  CycleRecord last;
  in.feedback.joint_mask = in.feedback.referenced_mask = in.feedback.enabled_mask = 31;
  in.feedback.is_guard_open = is_all;
  last.state = is_all ? State::kJogging : State::kRunning;
  std::uint64_t sum = 1;
  for (int i = 1; i <= count; ++i) {
    last.setpoint.cycle = in.feedback.cycle_seen = static_cast<std::uint64_t>(i);
    in.now_ns = in.feedback.arrival_ns = i * machine.cycle_ns;
    in.feedback.joint_arrival_ns.fill(in.now_ns);
    in.feedback.joint_cycle_seen.fill(in.feedback.cycle_seen);
    last.setpoint.position[0] = in.feedback.position[0] = 1e-3 * i;
    const MonitoringAlarm alarm = monitor.check(machine, in, last, false, 0);
    sum += static_cast<std::uint64_t>(alarm.alarm) + 1;
  }
  return sum;
}

}  // namespace meridian::bench
