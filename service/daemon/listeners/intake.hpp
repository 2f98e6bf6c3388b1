// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/daemon/listeners/participant_quota.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/protocol/intake_check.hpp"
#include "service/protocol/station/line_ends.hpp"
#include "service/recording/telemetry/journal/recovery.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/sources.hpp"
#include "service/transport/waitset.hpp"
#include "service/transport/writer.hpp"

namespace meridian::interpolator {

/// What intake reports in the status.
struct SessionView {
  std::uint64_t session = 0;
  std::string station, program, options;
  std::string identity;  ///< where the station runs
  std::uint64_t file_checksum = 0;
  std::uint32_t from_line = 0;
  bool is_move = false;  ///< dds::kPolicyMove; of the newest session, also once it is over
  std::uint64_t block_count = 0;
  std::uint64_t blocks_received = 0;
  std::uint64_t batches_dropped = 0, batches_lost = 0;
  std::string message;
};

/// The service's end of sessions on DDS: drains its readers always, asks the check, fills the block
/// queue, answers with credits.
class Intake {
 public:
  Intake(dds::Participant& participant, const MachineModel& model, const stream::ToolLengths& tools,
         const config::ServiceConfig& service, std::uint64_t service_id, Ports& ports);

  /// Runs until Ports::is_stopping.
  void run() noexcept;
  /// Any thread: there is something in a ring for intake.
  void wake() noexcept { waitset_.wake(); }
  /// Any thread: whether somebody reads actions.
  void set_action_peer(bool is_there) noexcept { has_action_peer_ = is_there; }
  /// Before run(): where the workpiece lies, and with which tools it is cut.
  void set_up(const SetUpInForce& in_force, const ToolTable& tools) {
    put_in_force(in_force);
    check_.set_tools(tools);
  }
  [[nodiscard]] SessionView view() const;
  /// Of credits, see dds::StalledReaders.
  [[nodiscard]] std::int32_t writer() const noexcept { return credits_.handle(); }
  /// Any thread: whether `block` of this session is the last of its source line; false also where
  /// that is not known.
  [[nodiscard]] bool is_line_end(std::uint64_t session, std::uint64_t block);
  /// Before run(): a program that is noted there as unfinished is gone on with by its own file,
  /// with its options and in its frame alone.
  void go_on_with(const telemetry::LastProgram& last, const telemetry::CutSetup& setup) {
    last_ = &last;
    setup_ = setup;
  }

 private:
  void take_events();
  void take_rejects();
  void free_idle_machine();
  void take_requests();
  [[nodiscard]] bool is_within_quota(std::uint64_t source);
  void take_request(const dds::SessionRequest& request, std::uint64_t source);
  /// False, and answered, where the set-up is being changed, or it was checked under another one.
  [[nodiscard]] bool may_open(const dds::SessionRequest& request);
  void put_in_force(const SetUpInForce& in_force) noexcept;
  /// False, and answered, where it goes on with another program than it says.
  [[nodiscard]] bool may_go_on(const dds::SessionRequest& request);
  void begin_session(const dds::SessionRequest& request);
  void take_batches();
  void look_for_station();
  /// False where the queue had no room for all.
  [[nodiscard]] bool push(const stream::Accepted& accepted);
  void note_line_ends(const stream::Accepted& accepted, std::size_t count);
  /// Lets the planner know where the blocks of a session end that was refused.
  void show_cut_off() noexcept;
  void empty_queue(std::uint16_t epoch) noexcept;
  void show_mark() noexcept;
  void publish(const std::optional<dds::Credit>& credit);
  void show();
  [[nodiscard]] stream::IntakeContext context() noexcept;

  /// Free slots that the check does not know of, for what is on its way while it computes credits.
  static constexpr std::size_t kReserve = 64;

  dds::Participant& participant_;
  Ports& ports_;
  const config::ServiceConfig& service_;
  MachineModel model_;
  SetUpInForce in_force_;
  stream::IntakeCheck check_;
  dds::Reader<dds::Batch> batches_;
  dds::Reader<dds::SessionRequest> requests_;
  dds::Writer<dds::Credit> credits_;
  dds::Waitset waitset_;

  dds::Senders senders_;
  ParticipantQuota quota_{50, 200};    ///< of sessions that are opened or closed
  std::uint64_t pushed_ = 0;           ///< blocks put into the queue, ever
  QueueMark mark_;                     ///< newest that was shown
  std::uint64_t refused_session_ = 0;  ///< newest session that was refused while it held
  std::uint64_t cut_off_session_ = 0;  ///< newest one that show_cut_off() reported
  std::int64_t idle_since_ns_ = 0;
  std::uint64_t station_source_ = 0;
  std::string station_identity_;
  bool is_station_there_ = false;
  std::int64_t looked_ns_ = 0;
  std::atomic<bool> has_action_peer_{false};

  trace::SpanWriter spans_;

  const telemetry::LastProgram* last_ = nullptr;
  telemetry::CutSetup setup_;
  std::string opened_, remark_;  ///< what was said of the newest session, and what goes with it

  mutable std::mutex view_mutex_;
  stream::LineEnds line_ends_;
  SessionView view_;
};

}  // namespace meridian::interpolator
