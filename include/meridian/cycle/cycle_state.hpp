// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/jog/jog_law.hpp"
#include "meridian/cycle/jog/jog_tool.hpp"
#include "meridian/cycle/rate_filter.hpp"
#include "meridian/cycle/state.hpp"
#include "meridian/cycle/stop/stop_law.hpp"
#include "meridian/cycle/stop/stop_mode.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/rate_limits.hpp"
#include "meridian/planner/time_law.hpp"

/// What step() reads, keeps and gives back. Everything is of fixed size. Units: mm, rad, s.
namespace meridian {

/// Times that are the service's to choose, not the machine's, and the order of homing.
struct CycleOptions {
  double enable_timeout_s = 5.0;     ///< drives must report operation enabled within it
  double disable_timeout_s = 1.0;    ///< after it Off is entered whatever the drives report
  double action_timeout_s = 30.0;    ///< an action must be done within it, else Held
  double feedback_timeout_s = 0.02;  ///< feedback older than it is lost
  double homing_timeout_s = 60;      ///< a drive must find its reference within it
  std::array<int, kMaxJoints> homing_turns{};  ///< of each joint, from 1 on; 0: its place
  bool stops_at_optional = false;              ///< until the operator says otherwise
};

/// The answer of the action peer to an action; an answer is given to exactly one step().
struct ActionAnswer {
  std::uint64_t sequence = 0;  ///< block whose action it answers
  bool is_answered = false;
  bool is_done = false;  ///< false: refused
};

/// What the monitoring beside the cycle found (meridian/monitoring): it stops the machine.
struct MonitoringAlarm {
  Alarm alarm = Alarm::kNone;
  int joint = 0;
  double value = 0;
};

/// Everything that one cycle knows about the world; time is an argument.
struct CycleInputs {
  Feedback feedback;                ///< newest; arrival_ns 0: none yet
  std::int64_t now_ns = 0;          ///< clock of `feedback.arrival_ns`
  std::int64_t due_ns = 0;          ///< scheduled wake-up of this period
  std::uint64_t cycle = 0;          ///< number of this period
  std::uint32_t lost_periods = 0;   ///< periods between the last executed one and this
  std::int32_t computation_ns = 0;  ///< time that the last step() took, for the record
  bool has_command = false;
  Command command;
  ActionAnswer action;
  JogOrder jog;               ///< newest of the operator who jogs
  std::uint64_t session = 0;  ///< open session, 0: none; starvation ends by itself only in its own
  double tool_length_mm = 0;  ///< of the tool in the spindle, where no program moves it
  /// A jog goes no faster, mm/s or rad/s of what it moves: the set-up mode of an open guard.
  double max_jog_speed = std::numeric_limits<double>::infinity();
  MonitoringAlarm monitoring;
};
static_assert(std::is_trivially_copyable_v<CycleInputs>);

inline constexpr std::size_t kMaxEvents = 24;

/// What one cycle gives to publisher and telemetry.
struct StepOutput {
  CycleRecord record;
  std::array<Event, kMaxEvents> events;
  std::size_t event_count = 0;
  std::uint32_t events_dropped = 0;  ///< more happened in one cycle than fits
};
static_assert(std::is_trivially_copyable_v<StepOutput>);

/// Setpoints are kept for that many cycles, to check the following error of feedback that saw them.
inline constexpr std::size_t kSentCycles = 256;

struct SentSetpoint {
  std::uint64_t cycle = 0;
  double bridged = 0;  ///< s that the drives had to go on by its velocity, periods being lost
  std::uint64_t periods_lost = 0;  ///< CycleState::periods_lost when it was sent
  JointVector position{};
  JointVector velocity{};
  JointVector drive_position{};  ///< drive coordinates, only where the machine has a stage
  JointVector drive_velocity{};
};

/// A stop that is going on: on the path, or with every joint on its own line where the path cannot
/// be evaluated any more.
struct StopInProgress {
  StopMode mode = StopMode::kNone;
  StopKind kind = StopKind::kHold;
  StopLaw law;             ///< path length; off the path: seconds at the speed of the begin
  double time = 0;         ///< since it or its law was laid out
  double passed = 0;       ///< path length of the path pieces left behind since then
  double rate_begin = 0;   ///< rate of plan time then, for the record
  double speed_begin = 0;  ///< ṡ then
  double stopping_time = 0, stopping_distance = 0;  ///< as laid out, for the report
  JointVector begin{};                              ///< joints when it began
  JointVector direction{};                          ///< off the path: joint velocity when it began
  JointVector deviation{};    ///< joints beside the path when it began (taken from feedback)
  double deviation_time = 0;  ///< time in which `deviation` is run down to zero

  [[nodiscard]] bool is_active() const noexcept { return mode != StopMode::kNone; }
  void change(StopEvent event) noexcept { mode = mode_after(mode, event); }
};

/// An operator's hand on the joints, one of them at a time, or on the tool.
struct Jogging {
  enum class Hold : std::uint8_t {
    kNone,     ///< nobody jogs
    kHeld,     ///< orders are taken
    kReleased  ///< the hand is gone: what moves comes to rest, and that was it
  };
  Hold hold = Hold::kNone;
  bool has_order = false;
  JogOrder order;          ///< in force
  double silence = 0;      ///< s since it came
  std::uint64_t hand = 0;  ///< orders of another one are void
  double distance = 0;     ///< that `axis` was laid out for
  int joint = -1;          ///< that `axis` moves; from kMaxJoints on a ToolAxis; -1: none yet
  bool is_ready = false;   ///< `axis` may move
  JogAxis axis;
  ToolPath tool_path;  ///< of a ToolAxis
  ToolSurvey survey;
  JogRates fault;  ///< what a FaultStop may use

  [[nodiscard]] bool is_active() const noexcept { return hold != Hold::kNone; }
  [[nodiscard]] bool is_let_go() const noexcept { return hold == Hold::kReleased; }
};

/// Drives that look for their references by themselves, group by group.
struct Homing {
  enum class Phase : std::uint8_t {
    kNone,    ///< no drive is homing
    kBegin,   ///< drives are asked for homing mode
    kSearch,  ///< they move until they find their references
    kHalt,    ///< they are commanded to stop searching
    kLeave,   ///< asked to follow setpoints again, which stand where they report to be
    kSettle   ///< until they have seen the setpoint that stays
  };
  Phase phase = Phase::kNone;
  bool has_failed = false;
  std::uint32_t left = 0;   ///< joints whose turn comes later
  std::uint32_t busy = 0;   ///< joints whose drives are homing; their setpoints are their feedback
  std::uint32_t begun = 0;  ///< of those, the ones that were seen to search
  double time = 0;          ///< s in this phase
  std::uint64_t settled_cycle = 0;  ///< the setpoint of this cycle stays

  [[nodiscard]] bool is_active() const noexcept { return phase != Phase::kNone; }
};

/// The program rests after every block, until the operator sends it on.
struct SingleBlock {
  enum class Phase : std::uint8_t {
    kRunning,
    kBraking,  ///< the rate goes down to rest at the end of `sequence`
    kResting   ///< at rest at the end of a block, which is done
  };
  bool is_on = false;
  Phase phase = Phase::kRunning;
  int pieces = 0;                ///< kBraking: that end before the time piece on which it lies
  double time = 0;               ///< kBraking: plan time on that piece
  std::uint64_t sequence = 0;    ///< of the block that ends there
  std::uint32_t line = 0;        ///< its source line
  std::uint64_t next_block = 0;  ///< ends of blocks before it are behind the machine

  [[nodiscard]] bool is_braking() const noexcept { return phase == Phase::kBraking; }
  [[nodiscard]] bool is_resting() const noexcept { return phase == Phase::kResting; }
  /// Something else than the end of a block brakes the machine from here on.
  void leave_brake() noexcept {
    if (is_braking()) phase = Phase::kRunning;
  }
};

/// Drives that are to be off, window by window (cycle/drive_watch.hpp).
struct DriveWatch {
  bool is_astray = false;          ///< enabled or moving at the end of the last window
  bool has_moved = false;          ///< `moved` is of the window before
  double time = 0;                 ///< s of this window
  std::uint32_t enabled_mask = 0;  ///< at its begin
  JointVector position{};          ///< drive coordinates at its begin
  JointVector moved{};
};

/// A program that was started to probe.
enum class ProbeState : std::uint8_t {
  kOff,      ///< none
  kSeeking,  ///< it moves until the probe reports contact, or is held
  kFound     ///< it comes to rest after its contact
};

/// The probe, as the cycle follows it (cycle/jog/probing.hpp).
struct Probing {
  ProbeState state = ProbeState::kOff;
  double free_time = 0;          ///< s since the probe touched anything, while drives were on
  JointVector free_joints{};     ///< kSeeking: feedback in the newest report without contact
  std::uint64_t free_cycle = 0;  ///< the cycle that saw it
  std::uint64_t free_seen = 0;   ///< Feedback::cycle_seen then
  std::int64_t free_arrival_ns = 0;
  double contact_travel_mm = 0;  ///< of motion that seeks nothing, in contact from its begin
};

/// What the action peer said about the action that the cycle waits for.
enum class ActionState : std::uint8_t { kNotReported, kWaiting, kDone, kRefused };

/// How fast the rate filter of this machine may change the rate.
[[nodiscard]] inline RateBounds rate_bounds(const MachineModel& machine) noexcept {
  const RateLimits rates = rate_limits(machine.override_ramp_s);
  return {rates.slope_per_s, rates.curvature_per_s2};
}

/// State of the cycle between two step() calls. Built once, no allocation afterwards.
struct CycleState {
  explicit CycleState(const CycleOptions& chosen = {}, const RateBounds& rates = {}) noexcept
      : options(chosen), rate(rates), stops_at_optional(chosen.stops_at_optional) {}

  CycleOptions options;
  State state = State::kOff;
  double state_time = 0;  ///< s since it was entered
  std::uint16_t epoch = 1;
  Alarm alarm = Alarm::kNone;         ///< why the machine is in FaultStop or Fault
  std::uint32_t alarms_reported = 0;  ///< one bit per Alarm since the last reset

  double feed_override = 1;   ///< wanted, 0 to MachineModel::max_feed_override
  double rapid_override = 1;  ///< wanted, 0 to 1
  RateFilter rate;
  double piece_time = 0;    ///< plan time since the piece in force began
  double program_time = 0;  ///< plan time from the program's start to the begin of that piece
  PathState on_path{};  ///< s in the path piece in force; ṡ, s̈ as they are, override included
  bool stops_at_optional = false;  ///< optional stops stop
  bool is_dry_run = false;         ///< drives stay off; see cycle/dry_run.hpp
  std::uint64_t stop_said = 0;     ///< Command::request of the newest stop that came
  SingleBlock single_block;
  StopInProgress stop;
  Jogging jogging;
  Homing homing;
  DriveWatch watch;
  Probing probing;

  JointVector joints{};                            ///< last commanded
  JointVector velocity{};                          ///< its time derivative
  JointVector latched_joints{}, latched_drives{};  ///< of a stage: feedback that was taken over
  MotionKind motion = MotionKind::kApproach;
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  bool has_block = false;  ///< kBlockStarted was emitted for `sequence`, kBlockDone was not

  double barrier_time = 0;  ///< s at the dwell or action in force
  ActionState action = ActionState::kNotReported;
  std::uint64_t starved_session = 0;
  std::uint64_t starvations = 0;
  std::uint64_t periods_lost = 0;
  std::uint64_t unheard = 0;  ///< setpoints sent since the one that the drives took last
  std::array<SentSetpoint, kSentCycles> sent{};
};

/// One step() call: what its parts hand to one another.
struct Cycle {
  const MachineModel& machine;
  CycleState& state;
  MotionReader& reader;
  const CycleInputs& in;
  StepOutput& out;
  double dt;                    ///< s per period
  int periods;                  ///< that motion goes on by: 1 and those that were lost
  JointVector previous;         ///< where the joints were before: last setpoint, or feedback
  double elapsed;               ///< s since `previous`
  const Feedback& drives;       ///< in.feedback; in a dry run what the drives would report
  const JointVector& feedback;  ///< position of `drives` as joints
};

/// The joints are where the drives are.
inline void take_over_feedback(Cycle& c) noexcept {
  c.state.joints = c.feedback;
  if (!has_stage(c.machine)) return;
  c.state.latched_joints = c.feedback;
  c.state.latched_drives = c.drives.position;
}

/// Emits an event; cycle, line and epoch are filled in. RT: cycle.
inline void emit(const Cycle& c, EventCode code, std::uint64_t a = 0, std::uint64_t b = 0,
                 double x = 0) noexcept {
  if (c.out.event_count == kMaxEvents) {
    ++c.out.events_dropped;
    return;
  }
  c.out.events[c.out.event_count++] = {code, c.in.cycle, a, b, x, c.state.line, c.state.epoch};
}

/// Enters `next` and reports it; nothing happens if the machine is there already. RT: cycle.
inline void enter(const Cycle& c, State next) noexcept {
  if (c.state.state == next) return;
  emit(c, EventCode::kStateChanged, static_cast<std::uint64_t>(next),
       static_cast<std::uint64_t>(c.state.state));
  c.state.state = next;
  c.state.state_time = 0;
}

}  // namespace meridian
