// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/service_file.hpp"

#include <gtest/gtest.h>

#include "support/text_file.hpp"

namespace meridian::config {
namespace {

TEST(ServiceFile, ThatIsShippedNamesFilesThatAreThere) {
  const ServiceConfig config = load_service(MERIDIAN_SOURCE_DIR "/deploy/service.toml");
  EXPECT_TRUE(std::filesystem::exists(config.machine)) << config.machine;
  EXPECT_TRUE(std::filesystem::exists(config.tools)) << config.tools;
}

TEST(ServiceFile, OfOneLineHasTheDefaults) {
  const test::TextFile file("[service]\nmachine = \"m.toml\"\n");
  const ServiceConfig config = load_service(file.path());
  EXPECT_EQ(config.machine, file.path().parent_path() / "m.toml");
  EXPECT_TRUE(config.tools.empty());
  EXPECT_TRUE(config.recording.empty());
  EXPECT_TRUE(config.state_directory.empty());
  EXPECT_TRUE(config.flight.folder.empty());
  EXPECT_EQ(config.flight.seconds, 10);
  EXPECT_EQ(config.realtime.mode, RealtimeMode::kEnforce);
  EXPECT_EQ(config.realtime.cycle_priority, 80);
  EXPECT_EQ(config.realtime.io_priority, 50);
  EXPECT_EQ(config.realtime.planner_priority, 40);
  EXPECT_EQ(config.auxiliary, AuxiliaryPolicy::kWait);
  EXPECT_EQ(config.dds_domain, 0);
  EXPECT_GE(config.block_queue, 5000);
  EXPECT_FALSE(config.bridge_cycles.has_value());
  EXPECT_TRUE(config.trace.folder.empty());
}

TEST(ServiceFile, GivesWhatItSays) {
  const test::TextFile file(
      "[service]\nmachine = \"/etc/m.toml\"\nauxiliary = \"ignore\"\nrecording = \"r.csv\"\n"
      "state_directory = \"kept\"\n"
      "bridge_cycles = 7\nblock_queue = 5000\noptional_stop = true\nfeedback_timeout_s = 0.25\n"
      "[audit_log]\nfile = \"a/who.log\"\nfile_mb = 3\nfiles = 4\n"
      "[flight_recorder]\nfolder = \"faults\"\nseconds = 2.5\nfaults = 7\n"
      "[realtime]\nmode = \"best_effort\"\ncpu = 1\nlock_memory = false\n"
      "[dds]\ndomain = 42\npartition = \"cell-3\"\n"
      "[trace]\nfolder = \"traces\"\nlate_us = 80\nfiles = 3\n");
  const ServiceConfig config = load_service(file.path());
  EXPECT_EQ(config.machine, "/etc/m.toml");
  EXPECT_EQ(config.recording, file.path().parent_path() / "r.csv");
  EXPECT_EQ(config.flight.folder, file.path().parent_path() / "faults");
  EXPECT_EQ(config.flight.seconds, 2.5);
  EXPECT_EQ(config.audit.file, file.path().parent_path() / "a/who.log");
  EXPECT_EQ(config.audit.file_mb, 3);
  EXPECT_EQ(config.audit.files, 4);
  EXPECT_EQ(config.flight.faults, 7);
  EXPECT_EQ(config.auxiliary, AuxiliaryPolicy::kIgnore);
  EXPECT_TRUE(config.optional_stop);
  EXPECT_EQ(config.state_directory, file.path().parent_path() / "kept");
  EXPECT_EQ(config.feedback_timeout_s, 0.25);
  EXPECT_EQ(config.bridge_cycles, 7);
  EXPECT_EQ(config.realtime.mode, RealtimeMode::kBestEffort);
  EXPECT_EQ(config.realtime.cpu, 1);
  EXPECT_FALSE(config.realtime.lock_memory);
  EXPECT_EQ(config.dds_domain, 42);
  EXPECT_EQ(config.dds_partition, "cell-3");
  EXPECT_EQ(config.trace.folder, file.path().parent_path() / "traces");
  EXPECT_EQ(config.trace.late_us, 80);
  EXPECT_EQ(config.trace.files, 3);
}

TEST(ServiceFile, BridgesFiftyMillisecondsInBestEffort) {
  ServiceConfig service;
  MachineModel machine;
  machine.cycle_ns = 250'000;
  EXPECT_EQ(find_bridge_cycles(service, machine), 3);
  service.realtime.mode = RealtimeMode::kBestEffort;
  EXPECT_EQ(find_bridge_cycles(service, machine), 200);
  service.bridge_cycles = 5;
  EXPECT_EQ(find_bridge_cycles(service, machine), 5);
}

struct ServiceMistake {
  const char* text;
  int line;
  const char* key;
  const char* allowed;
};

TEST(ServiceFile, ThatIsWrongIsRefusedWithLineAndKey) {
  const ServiceMistake mistakes[] = {
      {"", 0, "service", "table"},
      {"[service]\n", 1, "service.machine", "text"},
      {"[service]\nmachine = 5\n", 2, "service.machine", "text"},
      {"[service]\nmachine = \"m\"\nauxiliary = \"skip\"\n", 3, "service.auxiliary", "\"ignore\""},
      {"[service]\nmachine = \"m\"\nblock_queue = 100\n", 3, "service.block_queue", "5000"},
      {"[service]\nmachine = \"m\"\nbridge_cycles = -1\n", 3, "service.bridge_cycles", "0 to"},
      {"[service]\nmachine = \"m\"\n[flight_recorder]\nseconds = 600\n", 4,
       "flight_recorder.seconds", "1 to 60"},
      {"[service]\nmachine = \"m\"\n[realtime]\nmode = \"hard\"\n", 4, "realtime.mode",
       "\"enforce\", \"best_effort\""},
      {"[service]\nmachine = \"m\"\n[realtime]\ncycle_priority = 99\n", 4,
       "realtime.cycle_priority", "1 to 98"},
      {"[service]\nmachine = \"m\"\n[realtime]\npublisher_priority = 85\n", 4,
       "realtime.publisher_priority", "below"},
      {"[service]\nmachine = \"m\"\n[realtime]\nlock_memory = 1\n", 4, "realtime.lock_memory",
       "true"},
      {"[service]\nmachine = \"m\"\n[dds]\ndomain = 231\n", 4, "dds.domain", "0 to 230"},
      {"[service]\nmachine = \"m\"\n[dds]\npartition = 3\n", 4, "dds.partition", "text"},
      {"[service]\nmachine = \"m\"\n[trace]\nfiles = 0\n", 4, "trace.files", "1 to 1000"},
      {"[service]\nmachine = \"m\"\nmashine = \"m\"\n", 3, "service.mashine", "machine"},
      {"[service]\nmachine = \"m\"\n[dss]\ndomain = 1\n", 3, "dss", "dds"},
  };
  for (const ServiceMistake& mistake : mistakes) {
    const test::TextFile file(mistake.text);
    try {
      (void)load_service(file.path());
      ADD_FAILURE() << "accepted:\n" << mistake.text;
    } catch (const ConfigError& error) {
      if (mistake.line > 0) {
        EXPECT_EQ(error.fault().line, mistake.line) << error.what();
      }
      EXPECT_EQ(error.fault().key, mistake.key) << error.what();
      EXPECT_NE(error.fault().allowed.find(mistake.allowed), std::string::npos) << error.what();
      EXPECT_FALSE(error.fault().remedy.empty()) << error.what();
    }
  }
}

}  // namespace
}  // namespace meridian::config
