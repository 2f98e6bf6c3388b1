// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/histogram.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/soft_limits.hpp"
#include "meridian/kinematics/work_frame.hpp"
#include "meridian/path/cl_block.hpp"

/// What travels on the topics, in the words of the core. Rooms use these; the generated wire types
/// stop at service/transport/convert/convert.hpp. Units: as the names say, else house units (mm,
/// rad, s).
namespace meridian::dds {

inline constexpr std::size_t kBatchBlocks = 32;

/// `cl_batch`: up to kBatchBlocks consecutive blocks. `crc` is batch_crc() of the rest as the
/// sender computed it; whoever checks a batch computes it again.
struct Batch {
  std::uint64_t session = 0;
  std::uint64_t first_sequence = 0;
  std::uint32_t count = 0;
  bool is_end = false;  ///< no block follows this batch
  std::uint32_t crc = 0;
  std::array<ClBlock, kBatchBlocks> blocks{};
};

/// Returns the CRC-32C over session, first sequence, count, end mark and the used blocks (at most
/// kBatchBlocks), little-endian in the field order of idl/cl.idl.
[[nodiscard]] std::uint32_t batch_crc(const Batch& batch) noexcept;

/// So many characters of a station's options travel.
inline constexpr std::size_t kMaxOptions = 191;
/// Characters of a reply's text and of a status' message; what is longer is cut.
inline constexpr std::size_t kMaxText = 191;

enum class SessionRequestKind : std::uint8_t { kOpen, kClose };

enum SessionPolicy : std::uint32_t {
  kPolicyContainsActions = 1,  ///< the program has auxiliary, tool or stop blocks
  kPolicyExactStop = 2,        ///< rest at the end of every block, whatever the machine's file says
  kPolicySmooth = 4,           ///< on through blocks, whatever it says; not with kPolicyExactStop
  kPolicyRetractFirst = 8,     ///< it begins in the middle: off the part ahead of its first actions
  kPolicyChanged = 16,         ///< it goes on with a program although its file is another one now
  kPolicyMove = 32,            ///< an operator's move between programs: the journal stays as it is
  kPolicyFirstJoints = 64,     ///< the program begins where SessionRequest::first_joints say
};

/// `cl_session`: a station asks for the machine, or gives it back.
struct SessionRequest {
  std::uint64_t session = 0;  ///< drawn at random by the station, never 0
  SessionRequestKind request = SessionRequestKind::kOpen;
  std::string station{};
  std::string program{};
  std::uint64_t block_count = 0;  ///< 0: not known
  double tip_tolerance_mm = 0;    ///< 0: the machine's
  double axis_tolerance_rad = 0;  ///< 0: the machine's
  std::uint32_t policies = 0;     ///< SessionPolicy, or-ed
  std::string options{};          ///< of the station's command line, at most kMaxOptions characters
  std::uint64_t file_checksum = 0;  ///< FNV-1a, 64 bit, of the file's bytes; 0: not known
  std::uint32_t from_line = 0;      ///< the program begins with this line; 0: with its first
  std::uint64_t frame = 0;     ///< stream::frame_sum() that it was checked under; 0: under none
  std::uint64_t tools = 0;     ///< stream::tools_sum() that it was checked with; 0: with none
  std::uint64_t limits = 0;    ///< stream::limits_sum() that it was checked under; 0: under none
  JointVector first_joints{};  ///< with kPolicyFirstJoints
};

/// What the service thinks of a session. Everything from kRefusedStation on ends it.
enum class Verdict : std::uint8_t {
  kNone,            ///< nothing received yet
  kGood,            ///< everything up to next_sequence is in
  kComplete,        ///< the end mark is in
  kGap,             ///< blocks from next_sequence on are missing or were corrupted: send again
  kRan,             ///< the machine executed the program to its end
  kRefusedStation,  ///< another station holds the machine
  kRefusedProgram,  ///< the program as a whole cannot run here (no action peer, state)
  kRefusedBlock,    ///< verdict_sequence names the block, text the reason
  kBeyondCredit,    ///< the station sent past its credits
  kClosed,          ///< the station closed the session
  kAborted,         ///< the operator aborted, or a fault ended the program
};

/// `cl_credit`: how far a session has come. Repeated until the session ends.
struct Credit {
  std::uint64_t session = 0;
  std::uint64_t service_id = 0;
  std::uint64_t next_sequence = 0;  ///< the first block that the service has not got
  std::uint32_t credits = 0;        ///< blocks from next_sequence on that may be sent
  Verdict verdict = Verdict::kNone;
  std::uint64_t verdict_sequence = 0;
  std::uint32_t verdict_line = 0;
  std::int32_t verdict_joint = -1;
  double verdict_value = 0;
  std::string text{};
};

/// `command`: an operator's request. `request` and `operator_id` come back in the reply.
struct CommandRequest {
  std::uint64_t request = 0;
  std::uint64_t operator_id = 0;
  std::string operator_name{};
  Verb verb = Verb::kHold;
  std::uint16_t epoch_seen = 0;
  std::uint64_t status_seen = 0;
  std::uint64_t service_id_seen = 0;  ///< 0: any
  double argument = 0;
  FrameOrder frame{};            ///< of Verb::kFrame
  std::uint64_t tools_seen = 0;  ///< of Verb::kTool: stream::tools_sum() of the table before
  std::string tool_file{};  ///< of Verb::kTool, at most kToolFileBytes; empty: the service's own
  LimitsOrder limits{};     ///< of Verb::kLimits
};

/// `reply`
struct Reply {
  std::uint64_t request = 0;
  std::uint64_t operator_id = 0;
  std::uint64_t service_id = 0;
  std::uint64_t requester =
      0;  ///< participant that asked: number_of(), service/transport/sources.hpp
  Verb verb = Verb::kHold;
  bool is_accepted = false;
  Refusal refusal = Refusal::kNone;
  State state = State::kOff;
  std::uint16_t epoch = 0;
  std::string text{};
};

/// `jog`
struct Jog {
  std::uint64_t operator_id = 0;
  std::uint64_t sample = 0;
  std::uint64_t status_seen = 0;
  std::uint64_t service_id_seen = 0;  ///< 0: any
  std::uint16_t epoch_seen = 0;
  std::uint8_t frame = 0;  ///< 0: of the joints; 1: of the tool, `joint` is a ToolAxis
  std::uint8_t joint = 0;
  double velocity = 0;
  double distance = 0;
  std::int64_t dead_man_ns = 0;
};

/// What an enabling device says of itself. A value beyond these counts as released.
enum class EnablingDevice : std::uint8_t {
  kReleased,
  kPressed,
  kLeaves,  ///< its panel is closed: its heartbeat ends
};

/// `enabling`: the heartbeat of an enabling device.
struct Enabling {
  std::uint64_t operator_id = 0;
  std::uint64_t sample = 0;
  std::string operator_name{};
  EnablingDevice device = EnablingDevice::kReleased;
  std::uint64_t service_id_seen = 0;  ///< 0: any
};

/// `setpoint`: position and velocity in drive coordinates, drive order. `crc` is setpoint_crc() as
/// the sender computed it; drives compute it again.
struct SetpointSample {
  Setpoint setpoint;
  std::uint32_t crc = 0;
};

/// Returns the CRC-32C over `service_id` and the fields of `setpoint`, little-endian in the field
/// order of idl/drives.idl: it fits no setpoint of another service, nor one that was corrupted.
/// RT: no heap call. Proof: tests/unit/transport/setpoint_crc_test.cpp.
[[nodiscard]] std::uint32_t setpoint_crc(const Setpoint& setpoint,
                                         std::uint64_t service_id) noexcept;

/// CiA 402, objects 6060h and 6061h: how a drive works.
inline constexpr std::uint8_t kHomingMode = 6, kCyclicPositionMode = 8;

/// `drive_command`, one instance per drive
struct DriveCommand {
  std::uint8_t drive = 0;
  std::uint16_t controlword = 0;
  std::uint8_t mode = kCyclicPositionMode;
  std::uint16_t epoch = 0;
  std::uint64_t service_id = 0;
  std::uint64_t sample = 0;
};

/// `feedback`, without a key: readers keep several samples, or take on arrival
struct DriveFeedback {
  std::uint32_t drive_group = 0;
  std::uint32_t joint_mask = 0;
  std::uint64_t sample = 0;
  std::uint64_t cycle_seen = 0;
  std::uint64_t service_id = 0;  ///< whom the drives obey; 0: nobody
  JointVector position{};
  std::array<std::uint16_t, kMaxJoints> statusword{};
  std::array<std::uint16_t, kMaxJoints> error{};
  std::uint32_t referenced_mask = 0;
  bool is_emergency_stop = false;
  bool is_guard_open = false;
  ProbeInput probe = ProbeInput::kNone;
  std::array<std::uint8_t, kMaxJoints> mode_display{};  ///< 0: the drive does not say
};

/// `action`: what the path waits for at rest.
struct Action {
  std::uint64_t id = 0;
  std::uint64_t service_id = 0;
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  ActionKind kind = ActionKind::kNone;
  double value = 0;
  std::string text{};
};

/// `action_done`
struct ActionDone {
  std::uint64_t id = 0;
  std::uint64_t service_id = 0;
  bool is_done = false;
  std::string text{};
};

enum class RealtimeMode : std::uint8_t {
  kBestEffort,  ///< rights were missing or not asked for: timing is hoped for
  kEnforced     ///< FIFO priorities, pinned, memory locked
};

/// `status`
struct Status {
  std::uint64_t service_id = 0;
  std::uint64_t status_sequence = 0;
  std::int64_t time_ns = 0;
  std::uint64_t cycle = 0;
  State state = State::kOff;
  RealtimeMode realtime_mode = RealtimeMode::kBestEffort;
  bool is_secured = false;
  bool is_open_network = false;
  bool is_enabling_required = false;
  std::uint8_t enabling_devices = 0;
  bool is_auxiliary_ignored = false;
  Alarm alarm = Alarm::kNone;
  std::uint8_t alarm_joint = 0;
  std::uint16_t epoch = 0;
  std::uint32_t alarm_line = 0;
  double alarm_value = 0;
  std::uint64_t session = 0;
  std::string station{};
  std::string program{};
  std::uint64_t block_count = 0;
  std::uint64_t block = 0;
  std::uint32_t line = 0;
  MotionKind motion = MotionKind::kApproach;
  std::uint8_t branch = 0;
  bool is_at_pole = false;
  std::int32_t limiting_joint = -1;
  double feed_programmed_mm_per_min = 0;
  double feed_achieved_mm_per_min = 0;
  double feed_override = 1;
  double rapid_override = 1;
  bool is_single_block = false;
  bool stops_at_optional = false;
  bool is_dry_run = false;
  std::uint8_t work_frame = 0;  ///< number of the one in force; 0: the machine file's
  std::uint64_t frame = 0;      ///< its stream::frame_sum()
  std::uint64_t tools = 0;      ///< stream::tools_sum() of the tool table in force
  std::uint64_t limits = 0;     ///< stream::limits_sum() of the soft limits in force
  std::uint32_t tool = 0;       ///< number of the tool in the spindle; 0: that of the machine file
  double tool_length_mm = 0;    ///< gauge line to its tip
  double rate = 1;
  double plan_time_s = 0;
  JointVector joints{};
  std::uint32_t drives_enabled_mask = 0;
  std::uint32_t drives_fault_mask = 0;
  ProbeInput probe = ProbeInput::kNone;
  bool is_guard_open = false;
  std::uint32_t stops = 0;            ///< hold, abort and disable that were obeyed, so far
  std::uint32_t contacts = 0;         ///< of probing moves, since the service started
  std::uint32_t contact_periods = 0;  ///< of the newest: between its two reports
  JointVector contact_joints{};       ///< feedback in the report of the newest contact
  JointVector contact_free_joints{};  ///< and in the report before it
  std::uint64_t blocks_received = 0;
  std::uint64_t blocks_done = 0;
  std::uint32_t blocks_queued = 0;
  std::uint32_t pieces_queued = 0;
  double planned_s = 0;
  double stop_time_s = 0;
  double stop_distance_mm = 0;
  std::uint64_t cycles_run = 0;
  std::uint64_t periods_lost = 0;
  std::uint64_t starvations = 0;
  std::uint64_t batches_dropped = 0;
  std::uint64_t batches_lost = 0;
  std::uint64_t setpoints_overrun = 0;
  std::uint64_t records_overrun = 0;
  std::uint64_t events_overrun = 0;
  std::uint64_t commands_dropped = 0;
  std::uint64_t replies_dropped = 0;
  std::string stalled_reader{};
  std::string message{};
};

/// One joint of `machine`; the limits are those of MachineModel.
struct JointInfo {
  std::string name{};
  bool is_rotary = false;
  bool is_endless = false;
  std::uint16_t drive = 0;
  JointLimits limits;
  double home = 0;
};

/// `machine`: who serves which machine. It is also the service's claim on the machine.
struct MachineInfo {
  std::uint64_t service_id = 0;
  std::int64_t served_ns = 0;  ///< for how long it had served when it said so, by its own clock
  std::string name{};
  std::string file_version{};
  std::string service_version{};
  std::string host{};
  std::uint32_t pid = 0;
  bool is_serving = false;  ///< false: claims the machine and waits, or gives way to another one
  std::string kinematics{};
  std::string clock = "monotonic";
  std::int64_t cycle_ns = 0;
  std::uint32_t bridge_cycles = 0;
  std::uint32_t joint_count = 0;
  std::array<JointInfo, kMaxJoints> joints{};
  std::uint32_t stage_drive_count = 0;                 ///< 0: every joint has a drive of its own
  std::array<JointInfo, kStageDrives> stage_drives{};  ///< each in place of a joint, `drive`
  double max_feed_mm_per_min = 0;
  double tip_tolerance_mm = 0;
  double axis_tolerance_rad = 0;
  double tool_length_mm = 0;
  std::array<double, 9> frame_rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row
  Array3 frame_origin_mm{};
  std::uint8_t work_frame = 0;           ///< number of the one in force; 0: the machine file's
  std::vector<WorkFrame> work_frames{};  ///< the set-up, at most WorkFrames::kMax rows
  SoftLimits soft_limits{};              ///< in force; the limits of `joints` are the machine's own
  std::string machine_file{};  ///< its text; empty where it is longer than kMachineFileBytes
  std::string tool_file{};     ///< text of the tool table; empty: none, or longer than fits
};

inline constexpr std::size_t kMachineFileBytes = 12287, kToolFileBytes = 8191;

inline constexpr std::size_t kMaxHistograms = 8;

/// What a service measured of one thing since it started.
struct NamedHistogram {
  std::string name{};
  Histogram histogram{};
};

/// `latency`
struct Latency {
  std::uint64_t service_id = 0;
  std::int64_t time_ns = 0;
  std::vector<NamedHistogram> histograms{};  ///< at most kMaxHistograms
};

}  // namespace meridian::dds
