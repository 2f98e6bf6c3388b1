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
enum class Wire { kOnTime, kLate, kInHeaps };

/// Drives that lag by 2 ms behind the cycle, a wire, and the monitoring.
class MonitoredMachine {
 public:
  MonitoredMachine(const std::string& file, const MachineModel& model, Wire wire)
      : model_(model), wire_(wire), monitor_(limits_of(file, model)) {}

  void take(const CycleRecord& record) {
    if (record.setpoint.cycle == 0) return;
    CycleInputs next;
    for (std::size_t i = 0; i < servos_.size(); ++i) {
      if (!is_enabled(record.state)) servos_[i] = {record.joints[i], 0};
      servos_[i] = drives::follow(servos_[i], record.joints[i], 1e-9 * period(), lag_);
      at_[i] = servos_[i].position;
    }
    reports_.push_back(report_of(record));
    const bool has_gap = wire_ == Wire::kInHeaps && record.setpoint.cycle % 5 != 0;
    const std::size_t late = wire_ == Wire::kLate ? 10 : 0;
    while (!has_gap && reports_.size() > late) {
      seen_ = reports_.front();
      seen_.arrival_ns = now_of(record);
      reports_.pop_front();
    }
    next.feedback = seen_;
    next.now_ns = now_of(record);
    next.tool_length_mm = model_.tool_length_mm;
    const MonitoringAlarm alarm = monitor_.check(model_, next, record, false);
    if (alarm.alarm == Alarm::kNone || found_ != Alarm::kNone) return;
    found_ = alarm.alarm;
    ADD_FAILURE() << model_.name << ": alarm " << static_cast<int>(alarm.alarm) << " of joint "
                  << alarm.joint << " in cycle " << record.setpoint.cycle << ", " << alarm.value;
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
  Alarm found_ = Alarm::kNone;
};

[[nodiscard]] std::vector<std::string> machine_files() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(MERIDIAN_SOURCE_DIR "/deploy/machines")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  return files;
}

TEST(QuietMonitoring, FindsNothingInTheJointPatternOfAnyMachine) {
  const auto files = machine_files();
  EXPECT_GE(files.size(), 10U);
  for (const std::string& file : files) {
    const MachineModel model = config::load_machine(file);
    std::ostringstream pattern;
    inspect::write_joint_pattern(model, pattern);
    const std::string program = pattern.str();
    for (const Wire wire : {Wire::kOnTime, Wire::kLate, Wire::kInHeaps}) {
      MonitoredMachine machine(file, model, wire);
      cl::ClReader reader(std::string_view(program), file);
      const auto report = simulate::simulate(
          reader, file, model, {}, {}, [&](const CycleRecord& record) { machine.take(record); });
      EXPECT_EQ(report.outcome, simulate::Outcome::kDone) << file;
    }
  }
}

}  // namespace
}  // namespace meridian::test
