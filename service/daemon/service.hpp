// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/daemon/listeners/feedback_listener.hpp"
#include "service/daemon/listeners/intake.hpp"
#include "service/daemon/listeners/lease.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/daemon/ports/status_clock.hpp"
#include "service/daemon/supervisor/supervisor.hpp"
#include "service/daemon/threads/cycle_thread.hpp"
#include "service/daemon/threads/planner_thread.hpp"
#include "service/daemon/threads/publisher.hpp"
#include "service/daemon/threads/realtime.hpp"
#include "service/daemon/threads/telemetry_thread.hpp"
#include "service/machine/file/sections/homing_file.hpp"
#include "service/machine/file/sections/monitoring_file.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/recording/telemetry/audit_log.hpp"
#include "service/recording/telemetry/journal/set_up_file.hpp"
#include "service/recording/trace/tracer.hpp"
#include "service/transport/cyclone/stalled_reader.hpp"
#include "service/transport/participant.hpp"

namespace meridian::interpolator {

/// What a service is made of.
struct ServiceParts {
  MachineModel model;
  ToolTable tools;
  config::ServiceConfig service;
  config::HomingConfig homing;
  monitoring::Limits monitoring;
  std::uint32_t domain = 0;
  std::string recording;                ///< path; empty: none
  std::filesystem::path state_folder;   ///< of the journal; empty: none is kept
  std::string machine_file, tool_file;  ///< their texts, for the machine topic
};

/// The wiring: the one place where the rooms meet. Built by the main thread, which is pinned off
/// the real-time CPU by then.
class Service {
 public:
  /// Takes the machine's lease and creates everything; no thread of ours runs yet. Throws
  /// StartError, dds::DdsError or std::runtime_error.
  Service(const ServiceParts& parts, const Realtime& realtime, std::shared_ptr<spdlog::logger> log);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  void start();
  /// In Off, the thread that made the service: throws StartError where another service of the same
  /// machine was heard of only now and keeps it. A machine that is on goes on; drives obey one
  /// service.
  void keep_lease();
  /// Publishes a set-up that was changed; to be called several times a second, by the
  /// thread that made the service.
  void report_set_up();
  /// Logs who reports drives, and whom of two that report the same one the machine goes by; to be
  /// called several times a second, by the thread that made the service.
  void report_sources();
  /// Logs, and shows in the status, who does not acknowledge what the service sends; to be called
  /// about once a second, by the thread that made the service.
  void report_stalled_readers();
  /// Counts up with every cycle: one that stands still is a cycle that hangs.
  [[nodiscard]] std::uint32_t heartbeat() const noexcept { return ports_.publisher_wake.look(); }
  /// Brings the machine to rest and to Off; false where it is not there within `patience`.
  [[nodiscard]] bool switch_off(std::chrono::milliseconds patience);
  /// Ends all threads and closes the recording.
  void stop();

 private:
  [[nodiscard]] std::unique_ptr<trace::Tracer> make_tracer();
  void take_lease();
  /// What the set-up of this machine says, before it is published. Throws StartError.
  void read_set_up();
  /// The text of the tool table in force; empty where it is too long to be published.
  [[nodiscard]] std::string reported_tools(const telemetry::SetUp& set_up) const;
  void report_security();
  void report_last_program();

  ServiceParts parts_;
  const Realtime& realtime_;
  std::shared_ptr<spdlog::logger> log_;
  std::uint64_t service_id_;
  stream::ToolLengths tool_lengths_;
  const std::unique_ptr<trace::Rings> rings_;  ///< nullptr: nothing is traced
  Ports ports_;
  StatusClock status_clock_;
  dds::Participant participant_;
  Lease lease_;
  telemetry::SetUpFile set_up_;
  telemetry::AuditLog audit_;
  Publisher publisher_;
  FeedbackListener feedback_;
  Intake intake_;
  PlannerThread planner_;
  CycleThread cycle_;
  Supervisor supervisor_;
  telemetry::Recorder recorder_;
  telemetry::Journal journal_;
  telemetry::LastProgram last_program_;
  telemetry::FlightRecorder flight_;
  TelemetryThread telemetry_;
  std::unique_ptr<trace::Tracer> tracer_;
  dds::StalledReaders stalled_readers_;
  std::string stalled_;  ///< who stalls, as it was reported last
  std::vector<Thread> threads_;
  Thread recorder_thread_, journal_thread_, flight_thread_, audit_thread_;
  bool is_stopped_ = false;
};

}  // namespace meridian::interpolator
