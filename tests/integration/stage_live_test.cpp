// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>

#include "integration/live_run.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"

/// A machine whose stage stands between joints and drives, live: the wire carries other numbers
/// than the joints, and the run is the simulated one all the same.
namespace meridian::test {
namespace {

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
void check_wire(const Tap& tap, record::RecordingReader& recording, const MachineModel& model) {
  record::RecordingRow row;
  std::uint64_t compared = 0, moved = 0;
  while (recording.next(row).value_or(false)) {
    const auto at = tap.seen.find(row.cycle);
    if (at == tap.seen.end()) continue;
    ASSERT_EQ(at->second.position, drives_at(model, row.positions)) << "cycle " << row.cycle;
    ++compared;
    moved += (row.flags & kSetpointMoving) != 0;
  }
  std::printf("%llu setpoints seen on the wire, %llu of them moving\n",
              static_cast<unsigned long long>(compared), static_cast<unsigned long long>(moved));
  EXPECT_GT(moved, 100U);
}

TEST(LiveStage, SendsDriveCoordinatesAndEqualsTheSimulationBitForBit) {
  const std::string machine = "lai-hybrid";
  Plant plant(machine);
  Tap tap(plant.participant());
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 16, machine);
  LiveRun run;
  run.machine = machine;
  run.watch = [&tap] { tap.look(); };
  ASSERT_NO_FATAL_FAILURE(run_and_check(plant, part, run));

  const MachineModel model = config::load_machine(machine_file(machine));
  auto live = record::RecordingReader::open(plant.recording(), model);
  ASSERT_TRUE(live);
  check_wire(tap, *live, model);
  ASSERT_EQ(tap.machine.joint_count, static_cast<std::uint32_t>(model.joint_count));
  ASSERT_EQ(tap.machine.stage_drive_count, has_stage(model) ? 2U : 0U);
  for (std::uint32_t i = 0; i < tap.machine.stage_drive_count; ++i) {
    EXPECT_EQ(tap.machine.stage_drives[i].name, model.stage_drives[i].name);
    EXPECT_EQ(tap.machine.stage_drives[i].limits.jerk, model.stage_drives[i].limits.jerk);
  }
}

}  // namespace
}  // namespace meridian::test
