// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/daemon/monitoring/cycle_monitor.hpp"
#include "service/drives/simulated/servo.hpp"
#include "service/machine/file/sections/monitoring_file.hpp"

namespace meridian::test {

/// How reports of the drives arrive.
enum class Wire {
  kOnTime,
  kLate,
  kInHeaps,       ///< every fifth period
  kWithStalls,    ///< none for 60 periods, again and again
  kLosingPeriods  ///< the service loses one in 90, and 40 in 1000
};
inline constexpr std::array<Wire, 5> kWires{Wire::kOnTime, Wire::kLate, Wire::kInHeaps,
                                            Wire::kWithStalls, Wire::kLosingPeriods};

/// What is wrong with one drive, or with all of them.
enum class DriveFault {
  kNone,
  kSlow,     ///< all drives lag by twenty times what their model says
  kSpike,    ///< one report is off by what the drive moves in 0.1 s at most
  kFrozen,   ///< it reports the same position for ever
  kCreep,    ///< its reports creep by a sixtieth of its velocity limit
  kRunaway,  ///< its reports run away at twice its velocity limit
};

/// A fault of `drive` from cycle `from` on.
struct Injected {
  DriveFault fault = DriveFault::kNone;
  int drive = 0;
  std::uint64_t from = 0;
};

/// Drives that lag as their models say, or by 2 ms, a wire, and the monitoring.
class MonitoredMachine {
 public:
  MonitoredMachine(const MachineModel& model, const monitoring::Limits& limits, Wire wire,
                   const Injected& injected = {})
      : model_(model), wire_(wire), injected_(injected), monitor_(limits, 0.1) {
    for (std::size_t i = 0; i < lags_.size(); ++i) {
      if (limits.axes[i].has_model) lags_[i].time_constant_s = limits.axes[i].time_constant_s;
    }
  }

  /// What was found first, and in which cycle.
  [[nodiscard]] const MonitoringAlarm& found() const { return found_; }
  [[nodiscard]] std::uint64_t found_in_cycle() const { return found_in_; }

  void take(const CycleRecord& record) {
    if (record.setpoint.cycle == 0) return;
    reports_.push_back(report_of(record));
    const std::uint64_t cycle = record.setpoint.cycle;
    if (wire_ == Wire::kLosingPeriods && (cycle % 90 == 0 || cycle % 1000 < 40)) {
      ++next_.lost_periods;
      return;
    }
    const bool has_gap = (wire_ == Wire::kInHeaps && cycle % 5 != 0) ||
                         (wire_ == Wire::kWithStalls && cycle % 200 < 60);
    const std::size_t late = wire_ == Wire::kLate ? 10 : 0;
    while (!has_gap && reports_.size() > late) {
      seen_ = reports_.front();
      seen_.arrival_ns = now_of(record);
      seen_.joint_arrival_ns.fill(seen_.arrival_ns);
      seen_.joint_cycle_seen.fill(seen_.cycle_seen);
      reports_.pop_front();
    }
    next_.feedback = seen_;
    next_.now_ns = now_of(record);
    next_.tool_length_mm = model_.tool_length_mm;
    const MonitoringAlarm alarm = monitor_.check(model_, next_, record, false, 0);
    next_.lost_periods = 0;
    if (found_.alarm != Alarm::kNone || alarm.alarm == Alarm::kNone) return;
    found_ = alarm;
    found_in_ = cycle;
  }

 private:
  [[nodiscard]] double period_s() const { return 1e-9 * static_cast<double>(model_.cycle_ns); }
  [[nodiscard]] std::int64_t now_of(const CycleRecord& record) const {
    return static_cast<std::int64_t>(record.setpoint.cycle) * model_.cycle_ns;
  }
  [[nodiscard]] bool is_injected(DriveFault fault, std::uint64_t cycle) const {
    return injected_.fault == fault && cycle >= injected_.from;
  }
  /// One period of the drives, and what they report then.
  [[nodiscard]] Feedback report_of(const CycleRecord& record) {
    const std::uint64_t cycle = record.setpoint.cycle;
    Feedback report;
    for (std::size_t i = 0; i < servos_.size(); ++i) {
      const double target = record.setpoint.position[i];
      if (!is_enabled(record.state)) servos_[i] = {target, 0};
      drives::ServoLag lag = lags_[i];
      if (is_injected(DriveFault::kSlow, cycle)) lag.time_constant_s *= 20;
      servos_[i] = drives::follow(servos_[i], target, period_s(), lag);
      report.position[i] = servos_[i].position;
    }
    report.cycle_seen = cycle;
    report.joint_mask = report.referenced_mask = all_joints(model_);
    double& reported = report.position[static_cast<std::size_t>(injected_.drive)];
    const double velocity = drive_spec(model_, injected_.drive).limits.velocity;
    const double since_s = period_s() * static_cast<double>(cycle - injected_.from);
    if (cycle == injected_.from) frozen_ = reported;
    if (is_injected(DriveFault::kSpike, cycle) && cycle == injected_.from) {
      reported += 0.1 * velocity;
    }
    if (is_injected(DriveFault::kFrozen, cycle)) reported = frozen_;
    if (is_injected(DriveFault::kCreep, cycle)) reported += velocity / 60 * since_s;
    if (is_injected(DriveFault::kRunaway, cycle)) reported += 2 * velocity * since_s;
    return report;
  }

  const MachineModel& model_;
  Wire wire_;
  Injected injected_;
  interpolator::CycleMonitor monitor_;
  std::array<drives::ServoLag, kMaxJoints> lags_{};
  std::array<drives::ServoState, kMaxJoints> servos_{};
  double frozen_ = 0;
  std::deque<Feedback> reports_;
  Feedback seen_;
  CycleInputs next_;
  MonitoringAlarm found_;
  std::uint64_t found_in_ = 0;
};

}  // namespace meridian::test
