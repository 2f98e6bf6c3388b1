// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "meridian/cycle/state.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/path/path_piece.hpp"

/// What enters and leaves the cycle. Everything here is trivially copyable and of fixed size.
/// Units: mm, rad, s.
namespace meridian {

/// Flags of a setpoint, as sent to the drives.
enum SetpointFlag : std::uint16_t {
  kSetpointEnabled = 1,      ///< drives follow this setpoint
  kSetpointMoving = 2,       ///< commanded velocity is not zero
  kSetpointFaultStop = 4,    ///< part of a FaultStop
  kSetpointDry = 8,          ///< of a dry run: no drive follows it, whatever the other flags say
  kSetpointDryEnabled = 16,  ///< of a dry run in place of kSetpointEnabled, which none has
};

/// Whether the machine leads the joints by this setpoint, be it that nobody follows (dry run);
/// else it is where the drives are.
[[nodiscard]] constexpr bool is_leading(std::uint16_t flags) noexcept {
  return (flags & (kSetpointEnabled | kSetpointDryEnabled)) != 0;
}

/// What one cycle commands to the drives.
struct Setpoint {
  std::uint64_t cycle =
      0;  ///< counts periods since the cycle thread started; lost periods leave gaps
  std::int64_t due_ns = 0;  ///< scheduled wake-up of that period on the machine's clock
  JointVector position{};   ///< drive coordinates in drive order
  JointVector velocity{};   ///< their time derivative
  std::uint32_t line = 0;   ///< source line being cut
  std::uint16_t epoch = 0;
  std::uint16_t flags = 0;  ///< SetpointFlag
};

/// One executed cycle as the recording of record keeps it.
struct CycleRecord {
  Setpoint setpoint;
  JointVector joints{};        ///< machine order, before the actuator stage
  std::uint64_t sequence = 0;  ///< CL block
  double plan_time_s = 0;      ///< time on the plan, from the start of the program
  double rate = 1;             ///< d(plan time)/dt in force, 0 at rest after a hold
  State state = State::kOff;
  MotionKind motion = MotionKind::kApproach;
  std::int32_t lateness_ns = 0;     ///< actual wake-up minus due
  std::int32_t computation_ns = 0;  ///< time that the cycle before this one took
};

/// What the drives report of a touch probe.
enum class ProbeInput : std::uint8_t {
  kNone,    ///< none is connected
  kFree,    ///< it touches nothing
  kContact  ///< its stylus is deflected
};

/// In place of a joint: none.
inline constexpr std::uint8_t kNoJoint = 255;

/// The newest feedback of the drives, as the cycle sees it.
struct Feedback {
  std::int64_t arrival_ns = 0;           ///< receiver's own clock; 0: never
  std::uint64_t cycle_seen = 0;          ///< newest setpoint cycle that the drives took
  JointVector position{};                ///< drive coordinates in drive order
  std::uint32_t joint_mask = 0;          ///< joints that report
  std::uint32_t enabled_mask = 0;        ///< drives in operation enabled
  std::uint32_t fault_mask = 0;          ///< drives in fault
  std::uint32_t referenced_mask = 0;     ///< joints with a valid reference
  bool emergency_stop = false;           ///< reported, and not taken back since
  bool is_guard_open = false;            ///< of the work space: reported, or no longer reported
  ProbeInput probe = ProbeInput::kNone;  ///< kContact as soon as one group says so
  std::int64_t emergency_ns = 0;         ///< arrival of the newest report that says so; 0: none
  std::uint32_t homing_mask = 0;         ///< drives that are in homing mode, and of these
  std::uint32_t still_mask = 0;          ///< those whose homing is over, interrupted or not begun
  std::uint32_t homed_mask = 0;          ///< those that have attained their reference
  std::uint32_t homing_error_mask = 0;   ///< those whose homing failed
  std::uint32_t contested_mask = 0;      ///< joints that a second source reports too
  std::uint32_t foreign_mask = 0;        ///< joints whose drives obey another service
  std::uint8_t oldest_joint = 0;   ///< lowest of the group that `arrival_ns` is of; kNoJoint: it
                                   ///< has none, but the stop input
  std::uint8_t deafest_joint = 0;  ///< lowest of the group that `cycle_seen` is of
  std::array<std::int64_t, kMaxJoints> joint_arrival_ns{};   ///< of each joint's own group
  std::array<std::uint64_t, kMaxJoints> joint_cycle_seen{};  ///< the same
};

/// The newest word of the operator who jogs; every one has a larger `sample`.
struct JogOrder {
  std::uint64_t sample = 0;  ///< 0: none yet
  std::uint16_t epoch = 0;   ///< orders of another one are void
  bool is_tool = false;      ///< `joint` is a ToolAxis
  std::uint8_t joint = 0;
  double velocity = 0;
  double distance = 0;  ///< no farther from where it rested first; 0: to the end of travel
  double tool_length_mm = 0;
  double dead_man_s = 0;   ///< without a newer order for so long the joint comes to rest
  std::uint64_t hand = 0;  ///< Command::request of the `jog` that it belongs to
  double age_s = 0;        ///< it was said so long before it came in, or longer
};

/// An operator's word on its way to the cycle. `request` grows in the order in which words came,
/// and comes back in the reply event. What `argument` says hangs on the verb; of `enable` and
/// `start` 1: for a dry run alone; of `start` 2: a probing move.
struct Command {
  std::uint64_t request = 0;
  Verb verb = Verb::kHold;
  double argument = 0;
};

enum class EventCode : std::uint16_t {
  kStateChanged,   ///< a: new state, b: old state
  kAccepted,       ///< a: request, b: verb, x: its argument
  kRefused,        ///< a: request, b: verb, x: Refusal
  kBlockStarted,   ///< a: sequence, b: line
  kBlockDone,      ///< a: sequence, b: line
  kActionDue,      ///< a: sequence of the block whose action is to be published, b: line
  kProgramEnd,     ///< a: last sequence
  kEpochAdvanced,  ///< a: new epoch; queues of the old one are void
  kPeriodsLost,    ///< a: how many, b: 1 if drives bridge so many
  kStopped,        ///< hold, abort or FaultStop came to rest; a: stopping time ns, x: distance mm
  kPlanBegun,      ///< of the planner: a program is planned from here on, for its feed
  kFeedPlanned,    ///< of the planner: from span b of block a on for x times the feed (FeedMark)
  kAlarm,  ///< a: Alarm, b: place in limited.hpp or 0, x: measured value, line of the block in
           ///< `line`
  kActionAnswered,  ///< a: sequence, x: 1 done, 0 refused
  kJointsHomed,     ///< a: mask of the joints that have their reference now
  kPlanLooked,      ///< of the planner: branch and winding were chosen over a blocks, the first, or
                    ///< those from block b on; x: 1 if the stream stalled then
  kContactJoint,  ///< a: joint, b: 0 when the probe reported contact, 1 in the report before, when
                  ///< it was free; x: where the joint was by its feedback
  kContactFound,  ///< the probing move has its contact, behind the joints; a: periods between the
                  ///< two reports
};

/// Why the cycle took the machine to FaultStop, or refused to send a setpoint.
enum class Alarm : std::uint8_t {
  kNone,
  kNotFinite,    ///< guard: a setpoint was not a finite number
  kTravel,       ///< guard: a setpoint left travel
  kStep,         ///< guard: a setpoint stepped farther than the joint's velocity allows
  kUnreachable,  ///< the inverse kinematics found no solution
  kDriveFault,
  kFeedbackLost,
  kFollowingError,
  kEmergencyStop,
  kPeriodsLost,  ///< more periods lost than drives can bridge
  kEnableTimeout,
  kActionFailed,      ///< an action was refused or timed out (Held, not FaultStop)
  kHomingFailed,      ///< a drive found no reference (Ready, not FaultStop)
  kHomingTimeout,     ///< nor in the time that the machine's file allows (Ready, not FaultStop)
  kReferenceLost,     ///< of a joint, while a program holds the machine
  kDriveEnabled,      ///< a drive reports operation enabled in a dry run
  kSetpointsUnheard,  ///< drives report, and take no setpoints
  kDrivesAstray,      ///< drives obey another service, or are on or move where they are to be off
  kKeepOut,           ///< guard: a setpoint entered a keep-out box; the value is its number from 0
  kTipBox,            ///< guard: a setpoint took the tip out of its box; the joint is the axis of
                      ///< the base, 0 X, 1 Y, 2 Z, the value is where, mm
  kNoContact,         ///< a probing move came to its end without contact (Ready, not FaultStop)
  kContact,           ///< the probe touched something, and the motion was no probing move
  kProbeLost,         ///< the probe is connected no more, during a probing move
  kStandstill,        ///< monitoring: a joint left its place where it was to stand
  kJointSpeed,        ///< monitoring: a joint is faster than its mode allows
  kTipSpeed,          ///< monitoring: the tip is; no joint
  kPositionWindow,    ///< monitoring: a joint is outside of the window of its mode
  kDriveModel,        ///< monitoring: a joint is not where the model of its drive is
  kFeedbackJump,      ///< monitoring: a position jumped farther than the joint can move
  kFeedbackFrozen,    ///< monitoring: a position stays the same while the joint is led on
  kFeedbackTooFast,   ///< monitoring: positions pass faster than the joint can move
};

/// Why a verb was refused.
enum class Refusal : std::uint8_t {
  kNone,
  kWrongState,
  kNotReferenced,
  kNoProgram,
  kNoFeedback,
  kOutOfRange,
  kStale,
  kFaultPresent,
  kProgramPresent,  ///< a station holds the machine: what it sends is planned from where it stands
  kSlowRamp,        ///< the machine's override ramp is too long for single block
  kDriveEnabled,    ///< no dry run while a drive reports operation enabled, or did so last
  kDryRun,          ///< in a dry run nothing is homed
  kDriveContested,  ///< two sources report the same drive
  kNotDryRun,       ///< said for a dry run alone, and the machine is in none
  kOvertaken,       ///< a stop was said after it and came first
  kNoEnablingDevice,  ///< an enabling device is required, and none is pressed
  kDrivesTaken,       ///< the drives obey another service
  kDrivesAstray,      ///< drives are on or move although the machine has them off
  kNotJournalled,     ///< the set-up could not be written to where it survives the service
  kNoProbe,           ///< the drives report no probe that is connected
  kProbeContact,      ///< the probe is in contact before the move begins
  kGuardOpen,         ///< with an open guard the machine is jogged, and nothing else
};

/// Leaves the cycle as numbers and becomes words in service/recording/telemetry.
struct Event {
  EventCode code{};
  std::uint64_t cycle = 0;
  std::uint64_t a = 0, b = 0;
  double x = 0;
  std::uint32_t line = 0;
  std::uint16_t epoch = 0;
};

static_assert(std::is_trivially_copyable_v<Setpoint> && std::is_trivially_copyable_v<CycleRecord> &&
              std::is_trivially_copyable_v<Feedback> && std::is_trivially_copyable_v<Command> &&
              std::is_trivially_copyable_v<JogOrder> && std::is_trivially_copyable_v<Event>);

}  // namespace meridian
