// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "machines/monitored_machine.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/joint_pattern.hpp"
#include "service/programs/cl/cl_reader.hpp"

/// No false alarm: the monitoring beside programs of every shipped machine, with drives that lag
/// and a wire that is not in step. And the same runs with a fault of one drive, which is found as
/// what it is: silence alone proves nothing.
namespace meridian::test {
namespace {

/// All wires show the report of this cycle, and the last stall of any is 0.1 s ago.
constexpr std::uint64_t kFaultCycle = 1165;
constexpr std::uint64_t kRestCycles = 2000;

/// A machine and what it did in its joint pattern, at rest for a while after its end.
struct PatternRun {
  std::string file;
  MachineModel model;
  std::vector<CycleRecord> records;
  std::uint64_t rest_cycle = 0;  ///< first one at rest
};

PatternRun run_pattern(const std::string& file) {
  PatternRun run{.file = file, .model = config::load_machine(file), .records = {}};
  std::ostringstream pattern;
  inspect::write_joint_pattern(run.model, pattern);
  const std::string program = pattern.str();
  cl::ClReader reader(std::string_view(program), file);
  const auto report =
      simulate::simulate(reader, file, run.model, {}, {},
                         [&](const CycleRecord& record) { run.records.push_back(record); });
  EXPECT_EQ(report.outcome, simulate::Outcome::kDone) << file;
  CycleRecord rest = run.records.back();
  rest.state = State::kReady;
  run.rest_cycle = rest.setpoint.cycle + 1;
  for (std::uint64_t n = 0; n < kRestCycles; ++n) {
    ++rest.setpoint.cycle;
    run.records.push_back(rest);
  }
  return run;
}

/// Every shipped machine.
const std::vector<PatternRun>& runs() {
  static const std::vector<PatternRun> all = [] {
    std::vector<PatternRun> out;
    for (const auto& entry :
         std::filesystem::directory_iterator(MERIDIAN_SOURCE_DIR "/deploy/machines")) {
      if (entry.path().extension() == ".toml") out.push_back(run_pattern(entry.path().string()));
    }
    return out;
  }();
  return all;
}

/// What the machine file says by default.
monitoring::Limits default_limits(const PatternRun& run) {
  return config::load_monitoring(run.file, run.model);
}

/// Models of the drives too, each of a lag of its own, and bounds that are ten times tighter.
monitoring::Limits tight_limits(const PatternRun& run) {
  monitoring::Limits limits = default_limits(run);
  for (std::size_t i = 0; i < static_cast<std::size_t>(run.model.joint_count); ++i) {
    limits.axes[i].has_model = true;
    limits.axes[i].time_constant_s = 0.002 + 0.001 * static_cast<double>(i);
    limits.axes[i].model_error *= 0.1;
    limits.axes[i].standstill *= 0.1;
  }
  return limits;
}

MonitoredMachine replay(const PatternRun& run, const monitoring::Limits& limits, Wire wire,
                        const Injected& injected = {}) {
  MonitoredMachine machine(run.model, limits, wire, injected);
  for (const CycleRecord& record : run.records) {
    machine.take(record);
    if (machine.found().alarm != Alarm::kNone) break;
  }
  return machine;
}

std::string describe(const PatternRun& run, Wire wire, const MonitoredMachine& machine) {
  return (testing::Message() << run.file << ", wire " << static_cast<int>(wire) << ": alarm "
                             << static_cast<int>(machine.found().alarm) << " of joint "
                             << machine.found().joint << ", " << machine.found().value
                             << ", in cycle " << machine.found_in_cycle())
      .GetString();
}

/// How far the setpoints of `drive` go to and fro from cycle `from` on.
double led_by(const PatternRun& run, int drive, std::uint64_t from) {
  double low = 1e9, high = -1e9;
  for (const CycleRecord& record : run.records) {
    if (record.setpoint.cycle < from) continue;
    const double at = record.setpoint.position[static_cast<std::size_t>(drive)];
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return high - low;
}

/// Drives of a stage are counted behind the joints, as alarms count them.
int number_of(const PatternRun& run, int drive) {
  if (!has_stage(run.model)) return drive;
  if (drive == run.model.stage.linear_joint) return run.model.joint_count;
  if (drive == run.model.stage.rotary_joint) return run.model.joint_count + 1;
  return drive;
}

constexpr int kAnyNumber = -1;

/// Each drive of each machine over each wire has `fault` from `from` on: exactly `alarm` of that
/// drive, and not before.
void expect_found(const PatternRun& run, const monitoring::Limits& limits, const Injected& injected,
                  Alarm alarm, int number) {
  for (const Wire wire : kWires) {
    const MonitoredMachine machine = replay(run, limits, wire, injected);
    EXPECT_EQ(machine.found().alarm, alarm) << describe(run, wire, machine);
    if (number != kAnyNumber) {
      EXPECT_EQ(static_cast<int>(machine.found().joint), number) << describe(run, wire, machine);
    }
    EXPECT_GE(machine.found_in_cycle(), injected.from) << describe(run, wire, machine);
  }
}

TEST(QuietMonitoring, FindsNothingInTheJointPatternOfAnyMachine) {
  EXPECT_GE(runs().size(), 10U);
  for (const PatternRun& run : runs()) {
    for (const Wire wire : kWires) {
      const MonitoredMachine machine = replay(run, tight_limits(run), wire);
      EXPECT_EQ(machine.found().alarm, Alarm::kNone) << describe(run, wire, machine);
    }
  }
}

TEST(QuietMonitoring, FindsDrivesOfAnyMachineThatBecomeSlowInItsJointPattern) {
  for (const PatternRun& run : runs()) {
    for (const Wire wire : kWires) {
      const MonitoredMachine machine =
          replay(run, tight_limits(run), wire, {DriveFault::kSlow, 0, 1000});
      EXPECT_EQ(machine.found().alarm, Alarm::kDriveModel) << describe(run, wire, machine);
    }
  }
}

TEST(QuietMonitoring, FindsOneReportOfAnyDriveThatIsOffAsAJump) {
  for (const PatternRun& run : runs()) {
    for (int drive = 0; drive < run.model.joint_count; ++drive) {
      expect_found(run, default_limits(run), {DriveFault::kSpike, drive, kFaultCycle},
                   Alarm::kFeedbackJump, number_of(run, drive));
    }
  }
}

TEST(QuietMonitoring, FindsReportsOfAnyDriveThatFreezeAsFrozen) {
  constexpr std::uint64_t kFrom = 165;
  std::string rests;
  for (const PatternRun& run : runs()) {
    const monitoring::Limits limits = default_limits(run);
    for (int drive = 0; drive < run.model.joint_count; ++drive) {
      const double frozen = limits.axes[static_cast<std::size_t>(drive)].frozen;
      if (led_by(run, drive, kFrom) < 1.5 * frozen) {
        rests += ' ' + run.model.name + ' ' + drive_spec(run.model, drive).name;
        continue;
      }
      expect_found(run, limits, {DriveFault::kFrozen, drive, kFrom}, Alarm::kFeedbackFrozen,
                   number_of(run, drive));
    }
  }
  EXPECT_EQ(rests, " robot-6r spin") << "a pose does not show it, so no pattern moves it";
}

TEST(QuietMonitoring, FindsReportsOfAnyDriveThatCreepAgainstItsModel) {
  for (const PatternRun& run : runs()) {
    for (int drive = 0; drive < run.model.joint_count; ++drive) {
      expect_found(run, tight_limits(run), {DriveFault::kCreep, drive, kFaultCycle},
                   Alarm::kDriveModel, number_of(run, drive));
    }
  }
}

TEST(QuietMonitoring, FindsReportsOfAnyDriveThatCreepAtRestAsNoStandstill) {
  for (const PatternRun& run : runs()) {
    for (int drive = 0; drive < run.model.joint_count; ++drive) {
      SCOPED_TRACE(drive);
      for (const Wire wire : kWires) {
        const MonitoredMachine machine = replay(run, default_limits(run), wire,
                                                {DriveFault::kCreep, drive, run.rest_cycle + 600});
        EXPECT_EQ(machine.found().alarm, Alarm::kStandstill) << describe(run, wire, machine);
      }
    }
  }
}

TEST(QuietMonitoring, FindsReportsOfAnyDriveThatRunAwayAsTooFast) {
  for (const PatternRun& run : runs()) {
    for (int drive = 0; drive < run.model.joint_count; ++drive) {
      const int number = number_of(run, drive);
      const bool is_slider = number >= run.model.joint_count;  // its joint may be too fast first
      expect_found(run, default_limits(run), {DriveFault::kRunaway, drive, kFaultCycle},
                   Alarm::kFeedbackTooFast, is_slider ? kAnyNumber : number);
    }
  }
}

}  // namespace
}  // namespace meridian::test
