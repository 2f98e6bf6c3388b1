// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "meridian/cycle/state_table.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/daemon/monitoring/cycle_monitor.hpp"
#include "service/drives/simulated/servo.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/monitoring_file.hpp"
#include "service/machine/inspect/joint_pattern.hpp"
#include "service/programs/cl/cl_reader.hpp"

/// No false alarm: the monitoring beside programs of every shipped machine, with drives that lag
/// and a wire that is not in step.
namespace meridian::test {
namespace {

/// How reports of the drives arrive.
enum class Wire {
  kOnTime,
  kLate,
  kInHeaps,       ///< every fifth period
  kWithStalls,    ///< none for 60 periods, again and again
  kLosingPeriods  ///< the service loses one in 90, and 40 in 1000
};
constexpr std::array<Wire, 5> kWires{Wire::kOnTime, Wire::kLate, Wire::kInHeaps, Wire::kWithStalls,
                                     Wire::kLosingPeriods};

/// Drives that lag by 2 ms behind the cycle, a wire, and the monitoring.
class MonitoredMachine {
 public:
  MonitoredMachine(const std::string& file, const MachineModel& model, Wire wire)
      : model_(model), wire_(wire), monitor_(limits_of(file, model), 0.1) {}

  /// From cycle `from` on the drives lag by `factor` times what their model says.
  void slow_down(std::uint64_t from, double factor) {
    slow_from_ = from;
    slow_factor_ = factor;
  }
  [[nodiscard]] const MonitoringAlarm& found() const { return found_; }

  void take(const CycleRecord& record) {
    if (record.setpoint.cycle == 0) return;
    drives::ServoLag lag = lag_;
    if (record.setpoint.cycle >= slow_from_) lag.time_constant_s *= slow_factor_;
    for (std::size_t i = 0; i < servos_.size(); ++i) {
      if (!is_enabled(record.state)) servos_[i] = {record.joints[i], 0};
      servos_[i] = drives::follow(servos_[i], record.joints[i], 1e-9 * period(), lag);
      at_[i] = servos_[i].position;
    }
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
    if (found_.alarm == Alarm::kNone) found_ = alarm;
  }

 private:
  [[nodiscard]] static monitoring::Limits limits_of(const std::string& file,
                                                    const MachineModel& model) {
    monitoring::Limits limits = config::load_monitoring(file, model);
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
      limits.axes[i].has_model = true;
      limits.axes[i].time_constant_s = lag_.time_constant_s;
      limits.axes[i].model_error *= 0.1;
      limits.axes[i].standstill *= 0.1;
    }
    return limits;
  }
  [[nodiscard]] double period() const { return static_cast<double>(model_.cycle_ns); }
  [[nodiscard]] std::int64_t now_of(const CycleRecord& record) const {
    return static_cast<std::int64_t>(record.setpoint.cycle) * model_.cycle_ns;
  }
  [[nodiscard]] Feedback report_of(const CycleRecord& record) const {
    Feedback report;
    report.cycle_seen = record.setpoint.cycle;
    report.position = drives_of(model_, at_);
    report.joint_mask = report.referenced_mask = all_joints(model_);
    return report;
  }

  static constexpr drives::ServoLag lag_{};
  const MachineModel& model_;
  Wire wire_;
  interpolator::CycleMonitor monitor_;
  std::array<drives::ServoState, kMaxJoints> servos_{};
  JointVector at_{};
  std::deque<Feedback> reports_;
  Feedback seen_;
  CycleInputs next_;
  MonitoringAlarm found_;
  std::uint64_t slow_from_ = ~std::uint64_t{0};
  double slow_factor_ = 1;
};

[[nodiscard]] std::vector<std::string> machine_files() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(MERIDIAN_SOURCE_DIR "/deploy/machines")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  return files;
}

/// Runs the joint pattern of `machine`, whose file is `file`.
void run_pattern(const std::string& file, const MachineModel& model, MonitoredMachine& machine) {
  std::ostringstream pattern;
  inspect::write_joint_pattern(model, pattern);
  const std::string program = pattern.str();
  cl::ClReader reader(std::string_view(program), file);
  const auto report = simulate::simulate(reader, file, model, {}, {},
                                         [&](const CycleRecord& record) { machine.take(record); });
  EXPECT_EQ(report.outcome, simulate::Outcome::kDone) << file;
}

TEST(QuietMonitoring, FindsNothingInTheJointPatternOfAnyMachine) {
  const auto files = machine_files();
  EXPECT_GE(files.size(), 10U);
  for (const std::string& file : files) {
    const MachineModel model = config::load_machine(file);
    for (const Wire wire : kWires) {
      MonitoredMachine machine(file, model, wire);
      run_pattern(file, model, machine);
      EXPECT_EQ(machine.found().alarm, Alarm::kNone)
          << file << ", wire " << static_cast<int>(wire) << ": alarm "
          << static_cast<int>(machine.found().alarm) << " of joint " << machine.found().joint
          << ", " << machine.found().value;
    }
  }
}

TEST(QuietMonitoring, FindsDrivesOfAnyMachineThatBecomeSlowInItsJointPattern) {
  for (const std::string& file : machine_files()) {
    const MachineModel model = config::load_machine(file);
    for (const Wire wire : kWires) {
      MonitoredMachine machine(file, model, wire);
      machine.slow_down(1000, 20);
      run_pattern(file, model, machine);
      EXPECT_EQ(machine.found().alarm, Alarm::kDriveModel)
          << file << ", wire " << static_cast<int>(wire);
    }
  }
}

}  // namespace
}  // namespace meridian::test
