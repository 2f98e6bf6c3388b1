// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/spdlog.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/daemon/listeners/intake.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/daemon/ports/status_clock.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/recording/telemetry/audit_log.hpp"
#include "service/recording/telemetry/flight_recorder.hpp"
#include "service/recording/telemetry/journal/journal.hpp"
#include "service/recording/telemetry/journal/journal_keeper.hpp"
#include "service/recording/telemetry/journal/recovery.hpp"
#include "service/recording/telemetry/motion_watch.hpp"
#include "service/recording/telemetry/program_summary.hpp"
#include "service/recording/telemetry/recorder.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/cyclone/stalled_reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::interpolator {

/// Drains what the other threads report: events into words, records to the recorder, the last
/// executed block to the journal, timings into histograms; publishes the status at 20 Hz and on
/// change, latencies at 1 Hz.
class TelemetryThread {
 public:
  TelemetryThread(dds::Participant& participant, const MachineModel& model,
                  const config::ServiceConfig& service, std::uint64_t service_id,
                  dds::RealtimeMode mode, Intake& intake, StatusClock& status_clock,
                  telemetry::Recorder& recorder, telemetry::Journal& journal,
                  telemetry::FlightRecorder& flight, std::shared_ptr<spdlog::logger> log,
                  Ports& ports);

  /// Before run(): where the workpiece lies, and with which tools it is cut.
  void set_up(const SetUpInForce& in_force, const ToolTable& tools) {
    put_in_force(in_force);
    tools_ = tools;
  }
  /// Before run(): what the status says until there is something newer.
  void say_first(const std::string& message) { status_.message = message; }

  /// Before run(): the program that the journal names, and what the next is cut with.
  void go_on_from(telemetry::LastProgram& last, const telemetry::CutSetup& setup) {
    last_ = &last;
    setup_ = setup;
    keeper_.go_on_from(last.get());
  }
  /// Before run(): Faults and sessions go into this log too.
  void audit_into(telemetry::AuditLog& audit) { audit_ = &audit; }
  /// Of the status and of latencies, see dds::StalledReaders.
  void watch_readers(dds::StalledReaders& stalled) const {
    stalled.watch(statuses_.handle(), "status");
    stalled.watch(latencies_.handle(), "latency");
  }

  /// Runs until Ports::is_stopping; what is in the rings by then is drained.
  void run() noexcept;

 private:
  void drain();
  void take_view();
  void drain_records();
  /// A set-up that was put in force meanwhile; false: none was.
  bool take_set_up() noexcept;
  void put_in_force(const SetUpInForce& in_force) noexcept;
  void record_frame(std::uint64_t cycle) noexcept;
  void record_tools(std::uint64_t cycle) noexcept;
  void record_limits(std::uint64_t cycle) noexcept;
  /// What an accepted `verb` has put in force.
  void record_set_up(Verb verb, std::uint64_t cycle) noexcept;
  /// Lets the commands thread know that the newest status reports the newest set-up.
  void confirm_set_up() noexcept;
  /// Reports how the program went that is over; false: none is.
  bool report_program();
  void report(const Event& event);
  /// Which group is silent, where `event` is the alarm of one that is; else empty.
  [[nodiscard]] std::string silent_group(const Event& event);
  /// Takes how a program will be approached that was planned meanwhile; false: nothing new.
  bool take_approach();
  /// Its program will not be run.
  void forget_approach();
  /// Into the message of the status: what stations did, and the approach.
  void say_what_is_new(const SessionView& session, bool has_reported_program);
  /// `words` with the approach behind them, where that is still ahead.
  [[nodiscard]] std::string with_approach(const std::string& words) const;
  void keep_journal(std::int64_t now_ns);
  /// Of a contact that a probing move found.
  void keep_contact(const Event& event);
  /// A line of the audit log about what nobody commanded.
  void note(telemetry::AuditKind kind, const std::string& text, const SessionView& session);
  void publish_status(std::int64_t now_ns);
  void publish_latency(std::int64_t now_ns);

  MachineModel model_;
  SetUpInForce in_force_;
  ToolTable tools_;
  const config::ServiceConfig& service_;
  std::uint64_t service_id_;
  Intake& intake_;
  StatusClock& status_clock_;
  telemetry::Recorder& recorder_;
  telemetry::Journal& journal_;
  telemetry::FlightRecorder& flight_;
  std::shared_ptr<spdlog::logger> log_;
  Ports& ports_;
  telemetry::AuditLog* audit_ = nullptr;
  telemetry::LastProgram* last_ = nullptr;
  telemetry::CutSetup setup_;
  dds::Writer<dds::Status> statuses_;
  dds::Writer<dds::Latency> latencies_;

  CycleView view_;
  dds::Status status_;
  DriveWords words_;
  telemetry::MotionWatch motion_;
  telemetry::ProgramWatch program_;
  telemetry::JournalKeeper keeper_;
  enum Book : std::size_t {
    kLateness,  ///< lost periods are counted as if they had been executed (Histogram::record_every)
    kComputation,
    kWake,
    kSent,
    kWrite,
    kPlanning,
    kRoundTrip
  };
  static constexpr std::array kBooks{
      "wake-up lateness", "cycle computation",   "publisher's wake",    "sent minus due",
      "DDS write",        "planning of a block", "setpoint to feedback"};
  static_assert(kBooks.size() == kRoundTrip + 1 && kBooks.size() <= dds::kMaxHistograms);
  [[nodiscard]] Histogram& book(Book which) { return latency_.histograms[which].histogram; }
  dds::Latency latency_;
  std::int64_t status_ns_ = 0, latency_ns_ = 0;
  State reported_state_ = State::kOff;
  State state_of_events_ = State::kOff;  ///< after the newest kStateChanged
  int looks_ahead_ = 0;                  ///< at a view that is ahead of it
  std::uint64_t periods_lost_ = 0;       ///< since they were logged last
  bool has_news_ = true;
  std::string session_message_;  ///< newest of intake that was published
  std::string alarm_message_;    ///< of the newest alarm
  std::string notice_;           ///< newest that is for the operator, until the machine goes on
  std::string approach_;         ///< how the program that was planned last is approached
  Approach planned_approach_;    ///< the same
  bool is_approach_new_ = false;
  std::string approach_message_;  ///< the message that reported it last
};

}  // namespace meridian::interpolator
