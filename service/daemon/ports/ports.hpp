// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/jog/homing.hpp"
#include "meridian/cycle/latest_value.hpp"
#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/planner/approach.hpp"
#include "meridian/planner/feed_mark.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/relaxed_axis.hpp"
#include "meridian/planner/rewind.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/daemon/listeners/enabling_watch.hpp"
#include "service/daemon/ports/command_port.hpp"
#include "service/daemon/ports/queue_mark.hpp"
#include "service/daemon/ports/reply_queue.hpp"
#include "service/daemon/ports/sent_times.hpp"
#include "service/daemon/ports/set_up_port.hpp"
#include "service/daemon/ports/wake.hpp"
#include "service/recording/record/flight/flight_row.hpp"
#include "service/recording/trace/spans.hpp"

/// Everything that passes between the threads of the service, each with one writer and one reader.
///
///     receive thread ─stops─▶ cycle, ─arrivals─▶ commands ─replies─▶ replies
///     intake ─blocks─▶ planner ─motion─▶ cycle ─setpoints─▶ publisher, ─drives_asked─▶ drives
///       ▲ ▲              │ │              ▲ │ ├─events─▶ commands ─▶ telemetry
///       │ └───rejects────┘ └─actions──▶ commands        ├─records, timings─▶ telemetry ─▶ recorder
///       └──────────session_events── commands ──┘        └─views─▶ planner, commands, telemetry
namespace meridian::interpolator {

/// A block with the session that it belongs to.
struct QueuedBlock {
  std::uint64_t session = 0;
  ClBlock block;
  bool is_cut_off = false;  ///< no block: none comes any more, nor an end
};

/// How a session wants its program planned; stored before its first block is queued.
struct SessionSettings {
  std::uint64_t session = 0;
  SmoothSettings settings{};
};

/// An action block that was planned: what to publish when the cycle comes to it.
struct PlannedAction {
  std::uint16_t epoch = 0;
  ClBlock block;
};

struct SessionReject {
  std::uint64_t session = 0;
  BlockReject reject;
};

/// What the cycle lets others see of itself, as of its newest executed period.
struct CycleView {
  CycleRecord record;
  std::uint16_t epoch = 0;
  Alarm alarm = Alarm::kNone;
  double feed_override = 1, rapid_override = 1;
  bool is_single_block = false, stops_at_optional = false, is_dry_run = false;
  double feed_mm_per_s = 0;  ///< programmed, of the last motion of the program; 0: rapid
  std::uint8_t branch = 0;   ///< of the path piece in force
  bool is_at_pole = false;   ///< the redundant joint turns on the pole
  HomingAsked homing;        ///< what drives are asked for beside the machine's state
  std::uint64_t cycles_run = 0;
  std::uint64_t periods_lost = 0;
  std::uint64_t starvations = 0;
};

/// A command as it came from the wire, numbered in the order in which they came.
struct Arrival {
  std::uint64_t key = 0;     ///< CommandPort::next_request()
  std::uint64_t source = 0;  ///< writer, see dds::SampleInfo
  std::uint64_t request = 0, operator_id = 0, status_seen = 0, service_id_seen = 0;
  double argument = 0;
  std::uint16_t epoch_seen = 0;
  Verb verb = Verb::kHold;
  std::array<char, 64> operator_name{};  ///< zero-terminated
};

/// An enabling device began or ended its heartbeat.
struct EnablingChange {
  std::uint64_t source = 0;  ///< writer, see dds::SampleInfo
  EnablingWatch::Beat beat = EnablingWatch::Beat::kKnown;
  std::array<char, 64> name{};  ///< of its operator, zero-terminated
};

/// Something for the log, and where it is for the operator for the status too.
struct Notice {
  enum class Kind : std::uint8_t {
    kNews,     ///< for the log
    kWarning,  ///< for log and status; it stays there as the reason of a stop
    kOver      ///< for both: what the notice before said is over
  };
  Kind kind = Kind::kNews;
  std::array<char, dds::kMaxText + 1> text{};  ///< zero-terminated
};

/// Who does not acknowledge what the service writes; empty: nobody.
struct StalledReader {
  std::array<char, 128> name{};
};

/// What the machine asks of its drives.
struct DrivesAsked {
  bool is_enabled = false;  ///< to be in operation
  std::uint16_t epoch = 0;
  std::uint32_t homing_mask = 0;  ///< to be in homing mode
  std::uint32_t search_mask = 0;  ///< to search for their reference
  [[nodiscard]] bool operator==(const DrivesAsked&) const = default;
};

/// How long the parts of one cycle took. Unit: ns.
struct CycleTiming {
  std::int32_t lateness = 0;     ///< actual wake-up minus due
  std::int32_t computation = 0;  ///< step()
  std::int32_t wake = 0;         ///< waking the publisher
  std::uint32_t lost = 0;        ///< periods that nobody executed before this one
};

/// How one setpoint left. Unit: ns.
struct PublishTiming {
  std::int32_t sent_minus_due = 0;
  std::int32_t write = 0;  ///< time in DDS
};

/// CiA 402 statuswords as the drives sent them last, by joint, and what operators hear of who sends
/// them.
struct DriveWords {
  std::array<std::uint16_t, kMaxJoints> statusword{};
  std::array<std::uint16_t, kMaxJoints> error{};
  std::uint32_t joint_mask = 0, enabled_mask = 0, fault_mask = 0;
  std::uint32_t contested_mask = 0;  ///< drives that two sources report
  std::uint32_t oldest_group = 0;    ///< that has not reported for the longest
  std::uint32_t oldest_mask = 0;     ///< its drives; 0: it has none, but the stop input
  ProbeInput probe = ProbeInput::kNone;
  bool is_guard_open = false;
};

struct Ports {
  explicit Ports(trace::Rings* traced = nullptr) noexcept : spans(traced) {}

  trace::Rings* const spans;  ///< every thread to the tracer; nullptr: nothing is traced

  SpscRing<QueuedBlock, 8192> blocks;             ///< look-ahead of at least 5000 blocks
  LatestValue<SessionSettings> session_settings;  ///< intake to planner
  Wake planner_wake;
  SpscRing<SessionReject, 64> rejects;
  SpscRing<PlannedAction, 4096> actions;  ///< more than a planner takes before it publishes
  MotionPort motion;
  LatestValue<Approach> approach, approach_for_status;  ///< planner to commands, to telemetry
  SpscRing<RelaxedAxis, 256> relaxed_axes;              ///< planner to telemetry
  SpscRing<Rewind, 256> rewinds;                        ///< planner to telemetry
  SpscRing<FeedMark, 256> feed_marks;                   ///< planner to telemetry

  SpscRing<Arrival, 1024> arrivals;  ///< receive thread to commands
  CommandPort commands;
  ReplyQueue replies;  ///< commands to replies
  Wake reply_wake;
  LatestValue<DrivesAsked> drives_asked;               ///< cycle to drives, where it changed
  std::atomic<std::uint32_t> drives_asked_changes{0};  ///< counts them, for the publisher
  Wake drives_wake;
  EnablingWatch enabling;
  SpscRing<EnablingChange, 64> enabling_changes;  ///< receive thread to commands
  SpscRing<Notice, 64> notices;                   ///< commands to telemetry
  LatestValue<StalledReader> stalled_reader;      ///< main to telemetry
  LatestValue<Feedback> feedback;
  SpscRing<record::DriveReport, 8192> drive_reports;  ///< receive thread to telemetry: all of them
  LatestValue<ActionAnswer> action_answer;
  LatestValue<JogOrder> jog;

  SpscRing<Setpoint, 256> setpoints;
  Wake publisher_wake;
  SpscRing<PublishTiming, 8192> publish_timings;
  SpscRing<std::int32_t, 8192> plan_times;   ///< planner to telemetry: a block, ns
  SpscRing<std::int32_t, 8192> round_trips;  ///< receive thread to telemetry: setpoint sent until a
                                             ///< drive's first answer to it is here, ns
  SentTimes sent_times;
  SpscRing<CycleRecord, 8192> records;
  SpscRing<CycleTiming, 8192> timings;
  SpscRing<Event, 4096> events;
  SpscRing<Event, 4096> telemetry_events;  ///< all of them, passed on
  SpscRing<Event, 256> session_events;     ///< kProgramEnd; kEpochAdvanced, b 1: the queue stays
  LatestValue<CycleView> planner_view, commands_view, telemetry_view;
  LatestValue<DriveWords> drive_words, drive_words_for_status, drive_words_for_commands;

  std::atomic<bool> is_stopping{false};
  std::atomic<State> state{State::kOff};      ///< of the machine, for who needs no more than that
  std::atomic<bool> may_leave{true};          ///< no drive would be left alone: Off, or a dry run
  std::atomic<std::uint64_t> session{0};      ///< that holds the machine
  std::atomic<std::uint64_t> stop_status{0};  ///< newest status when a stop came last
  std::atomic<std::uint64_t> commands_dropped{0}, replies_dropped{0};
  std::atomic<double> spindle_tool_mm{0};      ///< gauge line to tip of the tool in the spindle
  std::atomic<std::uint32_t> spindle_tool{0};  ///< its number; 0: the one of the machine file
  std::atomic<bool> is_guard_open{false};      ///< only jogging is allowed, but for a dry run
  std::atomic<bool> is_tool_changing{false};   ///< that may be another one by now
  SetUpPorts set_up;
  QueueMarkWord queue_mark;          ///< intake to planner: what of `blocks` is good
  std::atomic<double> planned_s{0};  ///< plan time of the program that was published
  std::atomic<std::uint64_t> setpoints_overrun{0}, records_overrun{0}, events_overrun{0};
  std::atomic<std::uint64_t> writes_failed{0};

  static_assert(std::atomic<double>::is_always_lock_free);
};

}  // namespace meridian::interpolator
