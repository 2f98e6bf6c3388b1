// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "integration/plant.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/config/machine_file.hpp"
#include "service/record/compare.hpp"

/// A machine whose stage stands between joints and drives, live: the wire carries other numbers
/// than the joints, and the run is the simulated one all the same.
namespace meridian::test {
namespace {

/// The small program as a CL file, with a dwell and an action in it.
void write_cl_file(const std::string& path, int blocks, const std::string& machine) {
  const auto program = small_program(blocks, 4000, 2, machine);
  const std::size_t half = program.size() / 2;
  const std::vector<ClBlock> first(program.begin(), program.begin() + static_cast<long>(half));
  std::ofstream file(path);
  file << "PARTNO SMALL PROGRAM\nUNITS/MM\nSPINDL/8000,RPM,CLW\nFEDRAT/4000,MMPM\n"
       << cl_text(first) << "DELAY/0.3\nCOOLNT/FLOOD\n"
       << cl_text(program, half) << "FINI\n";
}

/// Takes every setpoint on the wire, and the description of the machine.
class Tap {
 public:
  explicit Tap(dds::Participant& participant) : setpoints_(participant), machines_(participant) {}

  void look() {
    dds::SetpointSample sample;
    while (setpoints_.take(sample)) seen[sample.setpoint.cycle] = sample.setpoint;
    (void)machines_.take(machine);
  }

  std::map<std::uint64_t, Setpoint> seen;
  dds::MachineInfo machine;

 private:
  dds::Reader<dds::SetpointSample> setpoints_;
  dds::Reader<dds::MachineInfo> machines_;
};

/// What the wire saw are the drive coordinates of the recording, bit for bit.
void judge_wire(const Tap& tap, record::RecordingReader& recording, const MachineModel& model) {
  record::RecordingRow row;
  std::uint64_t compared = 0, moved = 0;
  while (recording.next(row).value_or(false)) {
    const auto at = tap.seen.find(row.cycle);
    if (at == tap.seen.end()) continue;
    ASSERT_EQ(at->second.position, drives_at(model, row.places)) << "cycle " << row.cycle;
    ++compared;
    moved += (row.flags & kSetpointMoving) != 0;
  }
  recording.rewind();
  std::printf("%llu setpoints seen on the wire, %llu of them moving\n",
              static_cast<unsigned long long>(compared), static_cast<unsigned long long>(moved));
  EXPECT_GT(moved, 100U);
}

TEST(LiveStage, SendsDriveCoordinatesAndEqualsTheSimulationBitForBit) {
  const std::string machine = "lai-hybrid";
  Plant plant(machine);
  Tap tap(plant.participant());
  const std::string part = (plant.folder() / "part.cls").string();
  const std::string simulated = (plant.folder() / "simulated.csv").string();
  write_cl_file(part, 16, machine);
  Process simulate(
      {"meridian", "simulate", part, "--machine", machine_file(machine), "--record", simulated},
      plant.folder() / "simulate.log");
  ASSERT_EQ(simulate.wait(milliseconds(30000)), 0) << simulate.said();

  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process station({"meridian", "stream", part, "--domain", plant.domain(), "--machine-name",
                   machine, "--wait-end"},
                  plant.folder() / "station.log");
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said();
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start && start->is_accepted) << (start ? start->text : "no reply");
  ASSERT_TRUE(eventually(
      [&] {
        tap.look();
        return station.wait(milliseconds(0)).has_value();
      },
      milliseconds(60000)));
  ASSERT_EQ(station.wait(milliseconds(0)), 0) << station.said() << plant.service().said();
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(5000)), 0) << plant.service().said();

  const MachineModel model = config::load_machine(machine_file(machine));
  auto live = record::RecordingReader::open(plant.recording(), model);
  auto wanted = record::RecordingReader::open(simulated, model);
  ASSERT_TRUE(live && wanted);
  const auto report = record::compare(*live, *wanted, model);
  ASSERT_TRUE(report) << report.error().text();
  std::printf("%s\n", record::to_text(*report, "live", "simulated", model).c_str());
  EXPECT_TRUE(report->is_same());
  live->rewind();
  judge_wire(tap, *live, model);
  ASSERT_EQ(tap.machine.joint_count, static_cast<std::uint32_t>(model.joint_count));
  ASSERT_EQ(tap.machine.stage_drive_count, has_stage(model) ? 2U : 0U);
  for (std::uint32_t i = 0; i < tap.machine.stage_drive_count; ++i) {
    EXPECT_EQ(tap.machine.stage_drives[i].name, model.stage_drives[i].name);
    EXPECT_EQ(tap.machine.stage_drives[i].limits.jerk, model.stage_drives[i].limits.jerk);
  }

  Process check({"meridian", "check", plant.recording(), part, "--machine", machine_file(machine),
                 "--max-missing", "1000000"},
                plant.folder() / "check.log");
  EXPECT_EQ(check.wait(milliseconds(30000)), 0) << check.said();
}

}  // namespace
}  // namespace meridian::test
