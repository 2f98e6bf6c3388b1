// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/telemetry_thread.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/null_sink.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "support/machines.hpp"
#include "support/private_domain.hpp"

namespace meridian::interpolator {
namespace {

/// What the file of events holds after a run in which the verb `hold` was told and `lost` events
/// found no room on their way.
std::string events_file(std::uint64_t lost) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("meridian-telemetry-" + std::to_string(::getpid()) + ".csv");
  const MachineModel model = test::lai_machine();
  const support::PrivateDomain domain;
  dds::Participant participant({.domain = domain.id(), .machine = model.name});
  const auto ports = std::make_unique<Ports>();
  const config::ServiceConfig service;
  const stream::ToolLengths tools;
  const auto intake = std::make_unique<Intake>(participant, model, tools, service, 1, *ports);
  StatusClock clock;
  telemetry::Recorder recorder(path.string(), model);
  const auto log =
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::null_sink_mt>());
  telemetry::Journal journal("", model.name);
  telemetry::FlightRecorder flight({}, model, log);
  TelemetryThread thread(participant, model, service, 1, dds::RealtimeMode::kBestEffort, *intake,
                         clock, recorder, journal, flight, log, *ports);
  Event hold;
  hold.code = EventCode::kAccepted;
  hold.cycle = 7;
  hold.b = static_cast<std::uint64_t>(Verb::kHold);
  EXPECT_TRUE(ports->told.try_push(hold));
  ports->events_overrun = lost;
  ports->is_stopping = true;
  thread.run();
  recorder.stop();
  recorder.run();
  const std::string events = record::operator_events_path(path.string());
  std::ostringstream text;
  text << std::ifstream(events).rdbuf();
  std::filesystem::remove(path);
  std::filesystem::remove(events);
  return text.str();
}

TEST(TelemetryThread, TellsTheRecorderWhatWasLostOnTheWay) {
  EXPECT_EQ(events_file(0), "cycle,verb,argument,block,span\n7,hold,0\n");
  EXPECT_EQ(events_file(2), "cycle,verb,argument,block,span\n7,hold,0\nincomplete\n");
}

}  // namespace
}  // namespace meridian::interpolator
