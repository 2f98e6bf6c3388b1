// SPDX-License-Identifier: Apache-2.0
#include "integration/live_run.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>

#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/check/compare.hpp"
#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::test {
namespace {

using Words = std::vector<std::string>;

[[nodiscard]] Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// How the part is read and on which machine it is checked.
[[nodiscard]] Words checked(const Plant& plant, const LiveRun& live) {
  return joined(joined({"--machine", plant.machine()}, live.reader), live.simulate);
}

/// `meridian record` beside the station, listening already.
[[nodiscard]] std::unique_ptr<Process> listen(const Plant& plant, const LiveRun& live) {
  auto record = std::make_unique<Process>(
      Words{"meridian", "record", live.wire, "--mcap", live.wire + ".mcap", "--until-end",
            "--max-missing", "1000000", "--domain", plant.domain(), "--machine-name", live.machine},
      plant.folder() / "record.log");
  EXPECT_TRUE(
      eventually([&] { return record->said().find("listening to machine") != std::string::npos; },
                 milliseconds(8000)))
      << record->said();
  return record;
}

/// The MCAP file that was written beside `wire`: its rows, cycle by cycle, and its states.
void expect_as_mcap(const std::string& wire, const std::vector<std::uint64_t>& cycles) {
  const McapContent content = read_mcap(read_text(wire + ".mcap"));
  EXPECT_TRUE(content.has_end && content.is_sound);
  std::vector<std::uint64_t> written;
  std::size_t running = 0;
  for (const McapMessage& message : content.messages) {
    CdrParts parts(message.data);
    (void)parts.number<std::uint64_t>();  // its time
    if (message.topic == "/cycle") {
      EXPECT_EQ(parts.text(), "");
      written.push_back(parts.number<std::uint64_t>());
    } else if (message.topic == "/events") {
      (void)parts.number<std::uint8_t>();
      running += parts.text() == "state" && parts.text() == "running" ? 1U : 0U;
    }
  }
  EXPECT_EQ(written, cycles);
  EXPECT_GE(running, 1U);
}

}  // namespace

void write_cl_file(const std::string& path, int blocks, const std::string& machine) {
  const auto program = small_program(blocks, 4000, 2, machine);
  const std::size_t half = program.size() / 2;
  const std::vector<ClBlock> first(program.begin(), program.begin() + static_cast<long>(half));
  std::ofstream file(path);
  file << "PARTNO SMALL PROGRAM\nUNITS/MM\nSPINDL/8000,RPM,CLW\nFEDRAT/4000,MMPM\n"
       << cl_text(first) << "DELAY/0.3\nCOOLNT/FLOOD\n"
       << cl_text(program, half) << "FINI\n";
}

std::string service_file(const Plant& plant, const std::string& more) {
  constexpr std::int64_t kBridge_ns = 100'000'000;
  const std::int64_t cycles = kBridge_ns / config::load_machine(plant.machine()).cycle_ns;
  const std::string file = (plant.folder() / "service.toml").string();
  std::ofstream(file) << "[service]\nmachine = \"" << plant.machine()
                      << "\"\nbridge_cycles = " << cycles << "\nfeedback_timeout_s = 0.3\n"
                      << more;
  return file;
}

void run_live(Plant& plant, const std::string& part, const LiveRun& live) {
  plant.start_service(joined({"--service", service_file(plant, live.settings)}, live.service));
  if (live.is_dry_run) {
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kDryRun, 1));
  } else {
    plant.start_drives();
  }
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process station(joined(joined({"meridian", "stream", part, "--domain", plant.domain(),
                                 "--machine-name", live.machine, "--wait-end"},
                                live.reader),
                         live.station),
                  plant.folder() / "station.log");
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said();
  const auto record = live.wire.empty() ? nullptr : listen(plant, live);
  if (live.operate) {
    ASSERT_NO_FATAL_FAILURE(live.operate());
  } else {
    ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  }
  ASSERT_TRUE(eventually(
      [&] {
        live.watch();
        return station.wait(milliseconds(0)).has_value();
      },
      live.patience))
      << station.said() << plant.service().said();
  ASSERT_EQ(station.wait(milliseconds(0)), 0) << station.said() << plant.service().said();
  if (record) {
    ASSERT_EQ(record->wait(milliseconds(8000)), 0) << record->said();
    std::printf("%s\n", record->said().c_str());
  }
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(5000)), 0) << plant.service().said();
}

std::string simulate_part(const Plant& plant, const std::string& part, const LiveRun& live,
                          const Words& more) {
  const std::string simulated = plant.folder() / "simulated.csv";
  Process simulate(
      joined(joined({"meridian", "simulate", part, "--record", simulated}, checked(plant, live)),
             more),
      plant.folder() / "simulate.log");
  EXPECT_EQ(simulate.wait(milliseconds(60'000)), 0) << simulate.said();
  return simulated;
}

void expect_same(const Plant& plant, const std::string& simulated) {
  const MachineModel model = config::load_machine(plant.machine());
  auto is = record::RecordingReader::open(plant.recording(), model);
  auto wanted = record::RecordingReader::open(simulated, model);
  ASSERT_TRUE(is && wanted);
  const auto report = record::compare(*is, *wanted, model);
  ASSERT_TRUE(report) << report.error().text();
  std::printf("%s\n", record::to_text(*report, "live", "simulated", model).c_str());
  EXPECT_TRUE(report->is_same());
}

void expect_on_wire(const Plant& plant, const LiveRun& live) {
  const MachineModel model = config::load_machine(plant.machine());
  auto wire = record::RecordingReader::open(live.wire, model);
  auto service = record::RecordingReader::open(plant.recording(), model);
  ASSERT_TRUE(wire) << wire.error().text();
  ASSERT_TRUE(service) << service.error().text();
  record::RecordingRow seen, sent;
  const auto is_there = [](auto has_row) { return has_row && *has_row; };
  std::size_t count = 0, moving = 0;
  std::vector<std::uint64_t> cycles;
  while (is_there(wire->next(seen))) {
    cycles.push_back(seen.cycle);
    while (sent.cycle < seen.cycle) ASSERT_TRUE(is_there(service->next(sent))) << seen.cycle;
    if (sent.cycle != seen.cycle) continue;  // the recorder of the service lost it: counted there
    ++count;
    moving += (seen.flags & kSetpointMoving) != 0 ? 1U : 0U;
    ASSERT_EQ(seen.joints, sent.joints) << seen.cycle;
    ASSERT_EQ(seen.velocity, sent.velocity) << seen.cycle;
    ASSERT_EQ(seen.due_ns, sent.due_ns) << seen.cycle;
    ASSERT_EQ(seen.line, sent.line) << seen.cycle;
    ASSERT_EQ(seen.epoch, sent.epoch) << seen.cycle;
    ASSERT_EQ(seen.flags, sent.flags) << seen.cycle;
  }
  std::printf("%zu cycles on the wire, %zu of them in motion, as the service recorded them\n",
              count, moving);
  EXPECT_GT(moving, 1000U);
  expect_as_mcap(live.wire, cycles);
}

void expect_checked(const Plant& plant, const std::string& part, const LiveRun& live) {
  Process check(joined({"meridian", "check", plant.recording(), part, "--max-missing", "1000000"},
                       checked(plant, live)),
                plant.folder() / "check.log");
  EXPECT_EQ(check.wait(milliseconds(60'000)), 0) << check.said();
  std::printf("%s\n", check.said().c_str());
}

void run_and_check(Plant& plant, const std::string& part, const LiveRun& live) {
  const std::string simulated = simulate_part(plant, part, live);
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated));
  expect_checked(plant, part, live);
}

}  // namespace meridian::test
