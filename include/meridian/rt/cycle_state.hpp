// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "meridian/kinematics/joints.hpp"
#include "meridian/rt/cycle_data.hpp"
#include "meridian/rt/rate_filter.hpp"
#include "meridian/rt/state.hpp"
#include "meridian/rt/stop_law.hpp"

/// What step() reads, keeps and gives back. Everything is of fixed size. Units: mm, rad, s.
namespace meridian {

/// Times that are the service's to choose, not the machine's.
struct CycleOptions {
  double enable_timeout_s = 5.0;     ///< drives must report operation enabled within it
  double disable_timeout_s = 1.0;    ///< after it Off is entered whatever the drives report
  double action_timeout_s = 30.0;    ///< an action must be done within it, else Held
  double feedback_timeout_s = 0.02;  ///< feedback older than it is lost
};

/// The answer of the action peer to the newest action.
struct ActionAnswer {
  std::uint64_t sequence = 0;  ///< block whose action it answers
  bool is_answered = false;
  bool is_done = false;  ///< false: refused
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
  std::uint64_t session = 0;  ///< open session, 0: none; starvation ends by itself only in its own
  bool stops_at_optional = false;  ///< the operator asked for optional stops
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

/// How far the drives were when a setpoint was due: setpoints are kept so long for it.
inline constexpr std::size_t kSentCycles = 256;

/// A setpoint that was sent, to judge the following error of feedback that saw it.
struct SentSetpoint {
  std::uint64_t cycle = 0;
  JointVector position{};
};

/// A stop that is going on: on the path, or with every joint on its own line where the path cannot
/// be evaluated any more.
struct StopInProgress {
  bool is_active = false;
  bool is_off_path = false;   ///< joints run out along `direction` instead of the path
  StopLaw law;                ///< in path length, or in the share of `direction` (1: begin)
  double time = 0;            ///< since it began
  double passed = 0;          ///< path length of the pieces left behind since it began
  double speed_begin = 0;     ///< ṡ when it began
  JointVector begin{};        ///< is_off_path: joints when it began
  JointVector direction{};    ///< is_off_path: joint velocity when it began
  JointVector deviation{};    ///< joints beside the path when it began (taken from feedback)
  double deviation_time = 0;  ///< s in which `deviation` is run down to zero
};

/// State of the cycle between two step() calls. Built once, no allocation afterwards.
struct CycleState {
  explicit CycleState(const CycleOptions& chosen = {}, const RateBounds& rates = {}) noexcept
      : options(chosen), rate(rates) {}

  CycleOptions options;
  State state = State::kOff;
  std::uint16_t epoch = 1;
  double feed_override = 1;   ///< wanted, 0 to 1.5; above 1 it is the planner's business
  double rapid_override = 1;  ///< wanted, 0 to 1
  RateFilter rate;

  double piece_time = 0;    ///< plan time since the piece in force began
  double program_time = 0;  ///< plan time from the program's start to the begin of that piece
  StopInProgress stop;

  JointVector joints{};    ///< last commanded
  JointVector velocity{};  ///< its time derivative
  PathState on_path{};     ///< s in the path piece in force, ṡ, s̈ in force
  MotionKind motion = MotionKind::kApproach;
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  bool has_block = false;  ///< kBlockStarted was told for `sequence` and kBlockDone was not

  double state_time = 0;  ///< s since the state was entered
  double rest_time = 0;   ///< s of the barrier in force (dwell, action)
  bool is_action_due_told = false;
  std::uint64_t starved_session = 0;
  Alarm alarm = Alarm::kNone;  ///< why the machine is in FaultStop or Fault
  std::uint64_t starvations = 0;
  std::uint64_t periods_lost = 0;
  double unsent_time = 0;  ///< s since the last setpoint that was sent, before this cycle
  std::array<SentSetpoint, kSentCycles> sent{};
};

/// Adds an event to `out`; `cycle` and `epoch` are filled in. RT: cycle.
inline void tell(const CycleState& state, const CycleInputs& in, StepOutput& out, EventCode code,
                 std::uint64_t a = 0, std::uint64_t b = 0, double x = 0) noexcept {
  if (out.event_count == kMaxEvents) {
    ++out.events_dropped;
    return;
  }
  out.events[out.event_count++] = {code, in.cycle, a, b, x, state.line, state.epoch};
}

/// Enters `next` and tells it; nothing happens if the machine is there already. RT: cycle.
inline void enter(CycleState& state, const CycleInputs& in, StepOutput& out, State next) noexcept {
  if (state.state == next) return;
  tell(state, in, out, EventCode::kStateChanged, static_cast<std::uint64_t>(next),
       static_cast<std::uint64_t>(state.state));
  state.state = next;
  state.state_time = 0;
}

/// Seconds of one period. RT: cycle.
[[nodiscard]] inline double period_of(std::int64_t cycle_ns) noexcept {
  return static_cast<double>(cycle_ns) * 1e-9;
}

}  // namespace meridian
