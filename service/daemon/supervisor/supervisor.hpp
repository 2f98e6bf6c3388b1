// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/daemon/listeners/command_listener.hpp"
#include "service/daemon/listeners/enabling_listener.hpp"
#include "service/daemon/listeners/jog_intake.hpp"
#include "service/daemon/listeners/participant_quota.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/daemon/ports/status_clock.hpp"
#include "service/daemon/threads/drive_command_thread.hpp"
#include "service/daemon/threads/reply_thread.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/recording/telemetry/audit_log.hpp"
#include "service/recording/telemetry/journal/set_up_file.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/cyclone/stalled_reader.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/sources.hpp"
#include "service/transport/waitset.hpp"
#include "service/transport/writer.hpp"

namespace meridian::interpolator {

/// What is in force by the active row of the frames of `set_up`, or by `machine` itself where none
/// is, and by `tools`.
[[nodiscard]] SetUpInForce in_force_by(const telemetry::SetUp& set_up, const MachineModel& machine,
                                       const ToolTable& tools, std::uint32_t change);

/// The commands thread: operators' commands and jogs to the cycle and its answers back, actions out
/// and in, events on to who wants them, and the orderly end of the service. Stops reach the cycle
/// without it (CommandListener); it answers them. It waits for no peer: replies are written by a
/// thread of their own, controlwords by another.
class Supervisor {
 public:
  Supervisor(dds::Participant& participant, const MachineModel& model, const ToolTable& tools,
             const config::ServiceConfig& service, std::uint64_t service_id,
             const StatusClock& status_clock, Ports& ports, telemetry::AuditLog* audit = nullptr);
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Runs until Ports::is_stopping.
  void run() noexcept;
  /// Of replies, actions and controlwords, see dds::StalledReaders.
  void watch_readers(dds::StalledReaders& stalled) const {
    stalled.watch(replies_.writer(), "reply");
    stalled.watch(actions_.handle(), "action");
    stalled.watch(drives_.writer(), "drive_command");
  }
  /// The loops of two further threads, which run as long.
  void run_replies() noexcept { replies_.run(); }
  void run_drives() noexcept { drives_.run(); }
  /// Any thread: bring the machine to rest and to Off, then has_switched_off().
  void switch_off() noexcept;
  [[nodiscard]] bool has_switched_off() const noexcept { return is_off_.load(); }
  /// Before run(): `notify_intake` is called when there is something in a ring for intake, or when
  /// an action peer came or went.
  void on_session_event(std::function<void(bool has_action_peer)> notify_intake) {
    notify_intake_ = std::move(notify_intake);
  }
  /// Before run(): the set-up that `file` holds, and what is in force by it. Without it every
  /// change of work frames, tools and soft limits is refused.
  void keep_set_up(telemetry::SetUpFile& file, const telemetry::SetUp& set_up,
                   const ToolTable& tools, const SetUpInForce& in_force);
  /// Main thread: whether the set-up differs from the one it reported last; then set_up() and
  /// in_force() stay as they are until set_up_reported().
  [[nodiscard]] bool has_set_up_to_report() const noexcept {
    return has_set_up_to_report_.load(std::memory_order_acquire);
  }
  [[nodiscard]] const telemetry::SetUp& set_up() const noexcept { return set_up_; }
  [[nodiscard]] const SetUpInForce& in_force() const noexcept { return in_force_; }
  void set_up_reported() noexcept { has_set_up_to_report_.store(false, std::memory_order_release); }

 private:
  struct Pending {
    std::uint64_t key = 0;  ///< Command::request, in the order in which they came; 0: place is free
    std::uint64_t participant = 0;  ///< who asks, see dds::participant_of(); 0: gone
    std::uint64_t source = 0;       ///< by which writer, see dds::SampleInfo
    dds::CommandRequest request;
    std::uint64_t tools = 0;  ///< of verb `tool`: checksum of its text, which is not kept
  };
  struct SpindleTool {
    std::uint32_t number = 0;  ///< 0: that of the machine file
    double length_mm = 0;      ///< gauge line to tip
  };
  /// A tool change that the action peer was asked for, and has not answered.
  struct ToolChange {
    std::uint64_t id = 0;  ///< of the action; 0: none
    double tool = 0;
    std::int64_t until_ns = 0;  ///< nobody waits for the answer any longer
  };
  struct Answered {
    Pending command;
    QueuedReply reply;
  };

  void take_commands();
  void take_jogs();
  void take_command(const Arrival& arrival);
  /// Waits for the answer to a stop, which the cycle has received already.
  void await_stop(const Pending& command);
  /// Answers a command that came before as it was answered then; stops never come twice.
  [[nodiscard]] bool is_repetition(const Pending& command);
  /// Why a command that nothing else speaks against is refused all the same.
  [[nodiscard]] Refusal check_turn(const Pending& command) const noexcept;
  /// Why nothing may move now: an enabling device is required, and none is pressed.
  [[nodiscard]] bool lacks_enabling(Verb verb) const noexcept;
  /// Why it may not move by itself: a guard of the work space is open.
  [[nodiscard]] bool is_guarded_off(Verb verb) const noexcept;
  [[nodiscard]] bool is_within_quota(std::uint64_t participant, std::uint64_t source);
  void delay_reset(const Pending& command);
  /// What a command of verb `frame` says; an unknown word where that was lost.
  [[nodiscard]] FrameOrder read_frame_order(std::uint64_t key) noexcept;
  /// The same of verb `limits`.
  [[nodiscard]] LimitsOrder read_limits_order(std::uint64_t key) noexcept;
  /// The text of a command of verb `tool`, and which table it was made from; nothing where that was
  /// lost.
  [[nodiscard]] std::optional<std::string> read_tool_file(std::uint64_t key, std::uint64_t& seen);
  /// Whether its operator has not seen the set-up yet that is in force.
  [[nodiscard]] bool is_set_up_stale(const dds::CommandRequest& request) const noexcept;
  void begin_set_up_change(const Pending& command);
  /// Makes the next set-up of the one in force; false, and answered, where that cannot be.
  [[nodiscard]] bool change_frames(const Pending& command);
  [[nodiscard]] bool change_tools(const Pending& command);
  [[nodiscard]] bool change_limits(const Pending& command);
  void work_on_set_up_change();
  void ask_cycle_for_set_up();
  void answer_set_up(bool is_accepted, Refusal refusal);
  void pass_set_up_on();
  void take_set_up_back(Refusal refusal, const std::string& text);
  void end_set_up_change();
  [[nodiscard]] std::string words_of_frames() const;
  [[nodiscard]] std::string words_of_tools() const;
  [[nodiscard]] std::string words_of_limits() const;
  [[nodiscard]] SpindleTool in_spindle() const noexcept;
  void put_in_spindle(const SpindleTool& tool) noexcept;
  /// The same tool, as long as the table in force says.
  [[nodiscard]] SpindleTool measured(SpindleTool tool) const noexcept;
  void send(const Pending& command);
  /// The place for a command that waits for its answer; nullptr: there is none.
  [[nodiscard]] Pending* find_slot(Verb verb) noexcept;
  /// The verb of the service's own while it ends.
  void send_own(Verb verb);
  [[nodiscard]] bool is_pending(Verb verb) const noexcept;
  void take_events();
  void answer(const Event& event);
  void answer(const Event& event, const Pending& pending);
  /// The cycle's answers to commands before that of `event` are lost.
  void give_up_older(const Event& event);
  /// What an accepted verb leads to; a program's start to its approach.
  [[nodiscard]] std::string what_happens(const dds::CommandRequest& request);
  void reply(const Pending& command, bool is_accepted, Refusal refusal, const std::string& text);
  void push_reply(const QueuedReply& queued);
  void audit(const Pending& command, const QueuedReply& queued);
  /// Where the participant runs, in words; remembered.
  [[nodiscard]] const std::string& identity_of(const Pending& command);
  void take_enabling_changes();
  /// Says when a guard opens or shuts.
  void report_guard();
  void notice(const std::string& text, Notice::Kind kind);
  void publish_action(const Event& event);
  void take_actions_done();
  void settle_action(bool is_done);
  /// The action peer says what became of the tool change, whether or not a program waits for it.
  void end_tool_change(bool is_done);
  /// Nobody is waited for; what was answered is forgotten.
  void close_action();
  void send_delayed_resets();
  void work_on_switching_off();
  void look_for_action_peer();
  /// The newest view of the cycle, and what follows from a dry run that began or ended by it.
  void refresh_view();

  const MachineModel& model_;
  const ToolTable& own_tools_;  ///< of the service's own file
  ToolTable tools_;             ///< in force
  const config::ServiceConfig& service_;
  std::uint64_t service_id_;
  const StatusClock& status_clock_;
  Ports& ports_;
  telemetry::AuditLog* audit_;  ///< nullptr: none is kept
  dds::Participant& participant_;
  CommandListener commands_;
  ReplyThread replies_;
  dds::Reader<dds::Jog> jogs_;
  dds::Reader<dds::ActionDone> actions_done_;
  dds::Writer<dds::Action> actions_;
  DriveCommandThread drives_;
  EnablingListener enabling_;
  dds::Senders senders_;
  ParticipantQuota quota_{200, 400};  ///< of commands
  JogIntake jog_intake_;
  dds::Waitset waitset_;
  std::function<void(bool)> notify_intake_;

  CycleView view_;
  State reported_state_ = State::kOff;  ///< by the events so far
  std::array<Pending, 96> pending_{};
  std::array<Answered, 512> answered_{};  ///< for requests that come twice
  std::size_t answered_at_ = 0;
  PlannedAction action_{};  ///< newest that was due
  std::uint64_t action_id_ = 0;
  bool is_action_open_ = false;
  ToolChange tool_change_;
  bool has_action_peer_ = false;  ///< or a dry run, which needs none
  bool is_dry_run_ = false;
  SpindleTool tool_before_;  ///< in the spindle when the dry run began
  std::atomic<bool> is_switching_off_{false}, is_off_{false};
  std::int64_t asked_off_ns_ = 0, looked_ns_ = 0;
  std::uint32_t enabling_losses_ = 0;  ///< that were reported
  bool was_guard_open_ = false;
  struct EnablingDevice {
    std::uint64_t source = 0;
    std::string name;
  };
  std::array<EnablingDevice, 16> enabling_devices_{};  ///< newest, in a ring
  std::size_t enabling_devices_at_ = 0;
  struct Identity {
    std::uint64_t participant = 0;
    std::string name;
  };
  std::array<Identity, 32> identities_{};  ///< newest, in a ring
  std::size_t identities_at_ = 0;
  std::array<Pending, 8> delayed_resets_{};  ///< wait until drives left their fault
  std::size_t delayed_count_ = 0;
  std::int64_t delayed_until_ns_ = 0;

  /// How far the one change of the set-up has come that is being done.
  enum class SetUpPhase : std::uint8_t {
    kNone,
    kSaving,
    kAtTheCycle,
    kReverting,  ///< the cycle has refused it: the old set-up is written again
    kAccepted,   ///< it is in force at the cycle, and passed on to the other threads
    kReported    ///< it is in force: status and machine topic are to say so
  };
  telemetry::SetUpFile* set_up_file_ = nullptr;
  SetUpPhase set_up_phase_ = SetUpPhase::kNone;
  telemetry::SetUp set_up_, next_set_up_;  ///< in force; being set
  ToolTable next_tools_;                   ///< being set
  SetUpInForce in_force_;
  Pending set_up_command_;
  std::optional<std::string> tool_file_;     ///< of the newest command of verb `tool`
  Refusal set_up_refusal_ = Refusal::kNone;  ///< what it will be answered
  std::string set_up_text_;
  std::uint64_t set_up_status_ = 0;  ///< the first status that reported what is in force
  std::atomic<bool> has_set_up_to_report_{false};
};

}  // namespace meridian::interpolator
