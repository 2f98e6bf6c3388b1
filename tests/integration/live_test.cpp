// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "integration/plant.hpp"
#include "meridian/units.hpp"
#include "service/config/machine_file.hpp"
#include "service/record/compare.hpp"

namespace meridian::test {
namespace {

/// The small program as a CL file, with a dwell and an action in it.
void write_cl_file(const std::string& path, int blocks) {
  const auto program = small_program(blocks, 4000);
  const std::size_t half = program.size() / 2;
  const std::vector<ClBlock> first(program.begin(), program.begin() + static_cast<long>(half));
  std::ofstream file(path);
  file << "PARTNO SMALL PROGRAM\nUNITS/MM\nSPINDL/8000,RPM,CLW\nFEDRAT/4000,MMPM\n"
       << cl_text(first) << "DELAY/0.3\nCOOLNT/FLOOD\n"
       << cl_text(program, half) << "FINI\n";
}

/// Station, service, drives and operator as they are live; simulator and checker judge them.
TEST(Live, EqualsTheSimulationBitForBitOnEveryCycleThatWasSent) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  const std::string simulated = (plant.folder() / "simulated.csv").string();
  write_cl_file(part, 16);
  Process simulate(
      {"meridian", "simulate", part, "--machine", machine_file(), "--record", simulated},
      plant.folder() / "simulate.log");
  ASSERT_EQ(simulate.wait(milliseconds(30000)), 0) << simulate.said();

  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process station({"meridian", "stream", part, "--domain", plant.domain(), "--wait-end"},
                  plant.folder() / "station.log");
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said();
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start && start->is_accepted) << (start ? start->text : "no reply");
  ASSERT_EQ(station.wait(milliseconds(60000)), 0) << station.said() << plant.service().said();
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(5000)), 0) << plant.service().said();

  const MachineModel model = config::load_machine(machine_file());
  auto live = record::RecordingReader::open(plant.recording(), model);
  auto wanted = record::RecordingReader::open(simulated, model);
  ASSERT_TRUE(live && wanted);
  const auto report = record::compare(*live, *wanted, model);
  ASSERT_TRUE(report) << report.error().text();
  std::printf("%s\n", record::to_text(*report, "live", "simulated", model).c_str());
  EXPECT_TRUE(report->is_same());

  Process check({"meridian", "check", plant.recording(), part, "--machine", machine_file(),
                 "--max-missing", "1000000"},
                plant.folder() / "check.log");
  EXPECT_EQ(check.wait(milliseconds(30000)), 0) << check.said();
}

}  // namespace
}  // namespace meridian::test
