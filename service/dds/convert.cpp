// SPDX-License-Identifier: Apache-2.0
#include "service/dds/convert.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <type_traits>

namespace meridian::dds {
namespace {

template <class Enum>
[[nodiscard]] std::uint8_t octet(Enum value) noexcept {
  static_assert(sizeof(Enum) == 1);
  return static_cast<std::uint8_t>(value);
}

/// Between a std::array and a wire array of the same length, either way.
template <class From, class To>
void copy_array(const From& from, To& to) noexcept {
  static_assert(std::size(From{}) == std::extent_v<To> || std::extent_v<From> == std::size(To{}));
  std::copy(std::begin(from), std::end(from), std::begin(to));
}

template <std::size_t N>
void copy_text(const std::string& from, char (&to)[N]) noexcept {
  const std::size_t length = std::min(from.size(), N - 1);
  std::memcpy(to, from.data(), length);
  std::memset(to + length, 0, N - length);
}

template <std::size_t N>
[[nodiscard]] std::string text_of(const char (&from)[N]) {
  return {from, ::strnlen(from, N)};
}

void to_wire(const ClBlock& block, meridian_wire_ClBlock& wire) noexcept {
  wire.number = block.sequence;
  wire.line = block.line;
  wire.kind = octet(block.kind);
  wire.feed_meaning = octet(block.feed_meaning);
  wire.action = octet(block.action);
  wire.is_arc = block.is_arc ? 1 : 0;
  copy_array(block.tip_mm, wire.tip_mm);
  copy_array(block.axis, wire.axis);
  copy_array(block.centre_mm, wire.centre_mm);
  copy_array(block.normal, wire.normal);
  wire.sweep_rad = block.sweep_rad;
  wire.feed = block.feed;
  wire.value = block.value;
  std::memcpy(wire.text, block.text, sizeof wire.text);
}

void from_wire(const meridian_wire_ClBlock& wire, ClBlock& block) noexcept {
  block.sequence = wire.number;
  block.line = wire.line;
  block.kind = static_cast<BlockKind>(wire.kind);
  block.feed_meaning = static_cast<FeedMeaning>(wire.feed_meaning);
  block.action = static_cast<ActionKind>(wire.action);
  block.is_arc = wire.is_arc != 0;
  copy_array(wire.tip_mm, block.tip_mm);
  copy_array(wire.axis, block.axis);
  copy_array(wire.centre_mm, block.centre_mm);
  copy_array(wire.normal, block.normal);
  block.sweep_rad = wire.sweep_rad;
  block.feed = wire.feed;
  block.value = wire.value;
  std::memcpy(block.text, wire.text, sizeof block.text);
}

}  // namespace

static_assert(kBatchBlocks == meridian_wire_kBatchBlocks);
static_assert(kMaxHistograms == meridian_wire_kHistograms);
static_assert(kHistogramBuckets == meridian_wire_kHistogramBuckets);

void to_wire(const Batch& message, meridian_wire_ClBatch& wire) noexcept {
  wire.session = message.session;
  wire.first_sequence = message.first_sequence;
  wire.count = message.count;
  wire.is_end = message.is_end ? 1 : 0;
  wire.crc32c = message.crc;
  for (std::size_t i = 0; i < kBatchBlocks; ++i) to_wire(message.blocks[i], wire.blocks[i]);
}

void from_wire(const meridian_wire_ClBatch& wire, Batch& message) noexcept {
  message.session = wire.session;
  message.first_sequence = wire.first_sequence;
  message.count = wire.count;
  message.is_end = wire.is_end != 0;
  message.crc = wire.crc32c;
  for (std::size_t i = 0; i < kBatchBlocks; ++i) from_wire(wire.blocks[i], message.blocks[i]);
}

void to_wire(const SetpointSample& message, meridian_wire_Setpoint& wire) noexcept {
  wire.cycle = message.setpoint.cycle;
  wire.due_ns = message.setpoint.due_ns;
  copy_array(message.setpoint.position, wire.position);
  copy_array(message.setpoint.velocity, wire.velocity);
  wire.line = message.setpoint.line;
  wire.epoch = message.setpoint.epoch;
  wire.flags = message.setpoint.flags;
  wire.sent_minus_due_ns = message.sent_minus_due_ns;
}

void from_wire(const meridian_wire_Setpoint& wire, SetpointSample& message) noexcept {
  message.setpoint.cycle = wire.cycle;
  message.setpoint.due_ns = wire.due_ns;
  copy_array(wire.position, message.setpoint.position);
  copy_array(wire.velocity, message.setpoint.velocity);
  message.setpoint.line = wire.line;
  message.setpoint.epoch = wire.epoch;
  message.setpoint.flags = wire.flags;
  message.sent_minus_due_ns = wire.sent_minus_due_ns;
}

void to_wire(const SessionRequest& message, meridian_wire_ClSession& wire) noexcept {
  wire.session = message.session;
  wire.request = octet(message.request);
  copy_text(message.station, wire.station);
  copy_text(message.program, wire.program);
  wire.block_count = message.block_count;
  wire.tip_tolerance_mm = message.tip_tolerance_mm;
  wire.axis_tolerance_rad = message.axis_tolerance_rad;
  wire.policies = message.policies;
}

void from_wire(const meridian_wire_ClSession& wire, SessionRequest& message) {
  message.session = wire.session;
  message.request = static_cast<SessionRequestKind>(wire.request);
  message.station = text_of(wire.station);
  message.program = text_of(wire.program);
  message.block_count = wire.block_count;
  message.tip_tolerance_mm = wire.tip_tolerance_mm;
  message.axis_tolerance_rad = wire.axis_tolerance_rad;
  message.policies = wire.policies;
}

void to_wire(const Credit& message, meridian_wire_ClCredit& wire) noexcept {
  wire.session = message.session;
  wire.service_id = message.service_id;
  wire.next_sequence = message.next_sequence;
  wire.credits = message.credits;
  wire.verdict = octet(message.verdict);
  wire.verdict_sequence = message.verdict_sequence;
  wire.verdict_line = message.verdict_line;
  wire.verdict_joint = message.verdict_joint;
  wire.verdict_value = message.verdict_value;
  copy_text(message.text, wire.text);
}

void from_wire(const meridian_wire_ClCredit& wire, Credit& message) {
  message.session = wire.session;
  message.service_id = wire.service_id;
  message.next_sequence = wire.next_sequence;
  message.credits = wire.credits;
  message.verdict = static_cast<Verdict>(wire.verdict);
  message.verdict_sequence = wire.verdict_sequence;
  message.verdict_line = wire.verdict_line;
  message.verdict_joint = wire.verdict_joint;
  message.verdict_value = wire.verdict_value;
  message.text = text_of(wire.text);
}

void to_wire(const CommandRequest& message, meridian_wire_Command& wire) noexcept {
  wire.request = message.request;
  wire.operator_id = message.operator_id;
  copy_text(message.operator_name, wire.operator_name);
  wire.verb = octet(message.verb);
  wire.epoch_seen = message.epoch_seen;
  wire.status_seen = message.status_seen;
  wire.service_id_seen = message.service_id_seen;
  wire.argument = message.argument;
}

void from_wire(const meridian_wire_Command& wire, CommandRequest& message) {
  message.request = wire.request;
  message.operator_id = wire.operator_id;
  message.operator_name = text_of(wire.operator_name);
  message.verb = static_cast<Verb>(wire.verb);
  message.epoch_seen = wire.epoch_seen;
  message.status_seen = wire.status_seen;
  message.service_id_seen = wire.service_id_seen;
  message.argument = wire.argument;
}

void to_wire(const Reply& message, meridian_wire_Reply& wire) noexcept {
  wire.request = message.request;
  wire.operator_id = message.operator_id;
  wire.service_id = message.service_id;
  wire.verb = octet(message.verb);
  wire.is_accepted = message.is_accepted ? 1 : 0;
  wire.refusal = octet(message.refusal);
  wire.state = octet(message.state);
  wire.epoch = message.epoch;
  copy_text(message.text, wire.text);
}

void from_wire(const meridian_wire_Reply& wire, Reply& message) {
  message.request = wire.request;
  message.operator_id = wire.operator_id;
  message.service_id = wire.service_id;
  message.verb = static_cast<Verb>(wire.verb);
  message.is_accepted = wire.is_accepted != 0;
  message.refusal = static_cast<Refusal>(wire.refusal);
  message.state = static_cast<State>(wire.state);
  message.epoch = wire.epoch;
  message.text = text_of(wire.text);
}

void to_wire(const Jog& message, meridian_wire_Jog& wire) noexcept {
  wire.operator_id = message.operator_id;
  wire.sample = message.sample;
  wire.epoch_seen = message.epoch_seen;
  wire.joint = message.joint;
  wire.velocity = message.velocity;
  wire.dead_man_ns = message.dead_man_ns;
}

void from_wire(const meridian_wire_Jog& wire, Jog& message) noexcept {
  message.operator_id = wire.operator_id;
  message.sample = wire.sample;
  message.epoch_seen = wire.epoch_seen;
  message.joint = wire.joint;
  message.velocity = wire.velocity;
  message.dead_man_ns = wire.dead_man_ns;
}

void to_wire(const DriveCommand& message, meridian_wire_DriveCommand& wire) noexcept {
  wire.drive = message.drive;
  wire.controlword = message.controlword;
  wire.mode = message.mode;
  wire.epoch = message.epoch;
  wire.service_id = message.service_id;
  wire.sample = message.sample;
}

void from_wire(const meridian_wire_DriveCommand& wire, DriveCommand& message) noexcept {
  message.drive = wire.drive;
  message.controlword = wire.controlword;
  message.mode = wire.mode;
  message.epoch = wire.epoch;
  message.service_id = wire.service_id;
  message.sample = wire.sample;
}

void to_wire(const DriveFeedback& message, meridian_wire_Feedback& wire) noexcept {
  wire.drive_group = message.drive_group;
  wire.joint_mask = message.joint_mask;
  wire.sample = message.sample;
  wire.cycle_seen = message.cycle_seen;
  copy_array(message.position, wire.position);
  copy_array(message.statusword, wire.statusword);
  copy_array(message.error, wire.error);
  wire.referenced_mask = message.referenced_mask;
  wire.is_emergency_stop = message.is_emergency_stop ? 1 : 0;
}

void from_wire(const meridian_wire_Feedback& wire, DriveFeedback& message) noexcept {
  message.drive_group = wire.drive_group;
  message.joint_mask = wire.joint_mask;
  message.sample = wire.sample;
  message.cycle_seen = wire.cycle_seen;
  copy_array(wire.position, message.position);
  copy_array(wire.statusword, message.statusword);
  copy_array(wire.error, message.error);
  message.referenced_mask = wire.referenced_mask;
  message.is_emergency_stop = wire.is_emergency_stop != 0;
}

void to_wire(const Action& message, meridian_wire_Action& wire) noexcept {
  wire.id = message.id;
  wire.service_id = message.service_id;
  wire.block = message.sequence;
  wire.line = message.line;
  wire.kind = octet(message.kind);
  wire.value = message.value;
  copy_text(message.text, wire.text);
}

void from_wire(const meridian_wire_Action& wire, Action& message) {
  message.id = wire.id;
  message.service_id = wire.service_id;
  message.sequence = wire.block;
  message.line = wire.line;
  message.kind = static_cast<ActionKind>(wire.kind);
  message.value = wire.value;
  message.text = text_of(wire.text);
}

void to_wire(const ActionDone& message, meridian_wire_ActionDone& wire) noexcept {
  wire.id = message.id;
  wire.service_id = message.service_id;
  wire.is_done = message.is_done ? 1 : 0;
  copy_text(message.text, wire.text);
}

void from_wire(const meridian_wire_ActionDone& wire, ActionDone& message) {
  message.id = wire.id;
  message.service_id = wire.service_id;
  message.is_done = wire.is_done != 0;
  message.text = text_of(wire.text);
}

void to_wire(const Status& message, meridian_wire_Status& wire) noexcept {
  wire.service_id = message.service_id;
  wire.status_sequence = message.status_sequence;
  wire.time_ns = message.time_ns;
  wire.cycle = message.cycle;
  wire.state = octet(message.state);
  wire.realtime_mode = octet(message.realtime_mode);
  wire.is_secured = message.is_secured ? 1 : 0;
  wire.is_auxiliary_ignored = message.is_auxiliary_ignored ? 1 : 0;
  wire.alarm = octet(message.alarm);
  wire.alarm_joint = message.alarm_joint;
  wire.epoch = message.epoch;
  wire.alarm_line = message.alarm_line;
  wire.alarm_value = message.alarm_value;
  wire.session = message.session;
  copy_text(message.station, wire.station);
  copy_text(message.program, wire.program);
  wire.block_count = message.block_count;
  wire.block = message.block;
  wire.line = message.line;
  wire.motion = octet(message.motion);
  wire.branch = message.branch;
  wire.is_at_pole = message.is_at_pole ? 1 : 0;
  wire.limiting_joint = message.limiting_joint;
  wire.feed_programmed_mm_per_min = message.feed_programmed_mm_per_min;
  wire.feed_achieved_mm_per_min = message.feed_achieved_mm_per_min;
  wire.feed_override = message.feed_override;
  wire.rapid_override = message.rapid_override;
  wire.rate = message.rate;
  wire.plan_time_s = message.plan_time_s;
  copy_array(message.joints, wire.joints);
  wire.drives_enabled_mask = message.drives_enabled_mask;
  wire.drives_fault_mask = message.drives_fault_mask;
  wire.blocks_received = message.blocks_received;
  wire.blocks_done = message.blocks_done;
  wire.blocks_queued = message.blocks_queued;
  wire.pieces_queued = message.pieces_queued;
  wire.planned_s = message.planned_s;
  wire.stop_time_s = message.stop_time_s;
  wire.stop_distance_mm = message.stop_distance_mm;
  wire.cycles_run = message.cycles_run;
  wire.periods_lost = message.periods_lost;
  wire.starvations = message.starvations;
  wire.batches_dropped = message.batches_dropped;
  wire.batches_lost = message.batches_lost;
  wire.setpoints_overrun = message.setpoints_overrun;
  wire.records_overrun = message.records_overrun;
  wire.events_overrun = message.events_overrun;
  copy_text(message.message, wire.message);
}

void from_wire(const meridian_wire_Status& wire, Status& message) {
  message.service_id = wire.service_id;
  message.status_sequence = wire.status_sequence;
  message.time_ns = wire.time_ns;
  message.cycle = wire.cycle;
  message.state = static_cast<State>(wire.state);
  message.realtime_mode = static_cast<RealtimeMode>(wire.realtime_mode);
  message.is_secured = wire.is_secured != 0;
  message.is_auxiliary_ignored = wire.is_auxiliary_ignored != 0;
  message.alarm = static_cast<Alarm>(wire.alarm);
  message.alarm_joint = wire.alarm_joint;
  message.epoch = wire.epoch;
  message.alarm_line = wire.alarm_line;
  message.alarm_value = wire.alarm_value;
  message.session = wire.session;
  message.station = text_of(wire.station);
  message.program = text_of(wire.program);
  message.block_count = wire.block_count;
  message.block = wire.block;
  message.line = wire.line;
  message.motion = static_cast<MotionKind>(wire.motion);
  message.branch = wire.branch;
  message.is_at_pole = wire.is_at_pole != 0;
  message.limiting_joint = wire.limiting_joint;
  message.feed_programmed_mm_per_min = wire.feed_programmed_mm_per_min;
  message.feed_achieved_mm_per_min = wire.feed_achieved_mm_per_min;
  message.feed_override = wire.feed_override;
  message.rapid_override = wire.rapid_override;
  message.rate = wire.rate;
  message.plan_time_s = wire.plan_time_s;
  copy_array(wire.joints, message.joints);
  message.drives_enabled_mask = wire.drives_enabled_mask;
  message.drives_fault_mask = wire.drives_fault_mask;
  message.blocks_received = wire.blocks_received;
  message.blocks_done = wire.blocks_done;
  message.blocks_queued = wire.blocks_queued;
  message.pieces_queued = wire.pieces_queued;
  message.planned_s = wire.planned_s;
  message.stop_time_s = wire.stop_time_s;
  message.stop_distance_mm = wire.stop_distance_mm;
  message.cycles_run = wire.cycles_run;
  message.periods_lost = wire.periods_lost;
  message.starvations = wire.starvations;
  message.batches_dropped = wire.batches_dropped;
  message.batches_lost = wire.batches_lost;
  message.setpoints_overrun = wire.setpoints_overrun;
  message.records_overrun = wire.records_overrun;
  message.events_overrun = wire.events_overrun;
  message.message = text_of(wire.message);
}

namespace {

void to_wire(const JointInfo& from, meridian_wire_Joint& to) noexcept {
  copy_text(from.name, to.name);
  to.is_rotary = from.is_rotary ? 1 : 0;
  to.is_endless = from.is_endless ? 1 : 0;
  to.drive = from.drive;
  to.travel_min = from.limits.travel_min;
  to.travel_max = from.limits.travel_max;
  to.velocity = from.limits.velocity;
  to.acceleration = from.limits.acceleration;
  to.jerk = from.limits.jerk;
  to.fault_acceleration = from.limits.fault_acceleration;
  to.fault_jerk = from.limits.fault_jerk;
  to.following_error = from.limits.following_error;
  to.home = from.home;
}

void from_wire(const meridian_wire_Joint& from, JointInfo& to) {
  to.name = text_of(from.name);
  to.is_rotary = from.is_rotary != 0;
  to.is_endless = from.is_endless != 0;
  to.drive = from.drive;
  to.limits.travel_min = from.travel_min;
  to.limits.travel_max = from.travel_max;
  to.limits.velocity = from.velocity;
  to.limits.acceleration = from.acceleration;
  to.limits.jerk = from.jerk;
  to.limits.fault_acceleration = from.fault_acceleration;
  to.limits.fault_jerk = from.fault_jerk;
  to.limits.following_error = from.following_error;
  to.home = from.home;
}

}  // namespace

void to_wire(const MachineInfo& message, meridian_wire_Machine& wire) noexcept {
  wire.service_id = message.service_id;
  wire.started_ns = message.started_ns;
  copy_text(message.name, wire.name);
  copy_text(message.file_version, wire.file_version);
  copy_text(message.service_version, wire.service_version);
  copy_text(message.host, wire.host);
  wire.pid = message.pid;
  wire.is_serving = message.is_serving ? 1 : 0;
  copy_text(message.kinematics, wire.kinematics);
  copy_text(message.clock, wire.clock);
  wire.cycle_ns = message.cycle_ns;
  wire.bridge_cycles = message.bridge_cycles;
  wire.joint_count = message.joint_count;
  for (std::size_t i = 0; i < kMaxJoints; ++i) to_wire(message.joints[i], wire.joints[i]);
  wire.stage_drive_count = message.stage_drive_count;
  for (std::size_t i = 0; i < kStageDrives; ++i) {
    to_wire(message.stage_drives[i], wire.stage_drives[i]);
  }
  wire.max_feed_mm_per_min = message.max_feed_mm_per_min;
  wire.tip_tolerance_mm = message.tip_tolerance_mm;
  wire.axis_tolerance_rad = message.axis_tolerance_rad;
  wire.tool_length_mm = message.tool_length_mm;
  std::copy(message.frame_rotation.begin(), message.frame_rotation.end(), wire.frame_rotation);
  std::copy(message.frame_origin_mm.begin(), message.frame_origin_mm.end(), wire.frame_origin_mm);
  copy_text(message.machine_file, wire.machine_file);
  copy_text(message.tool_file, wire.tool_file);
}

void from_wire(const meridian_wire_Machine& wire, MachineInfo& message) {
  message.service_id = wire.service_id;
  message.started_ns = wire.started_ns;
  message.name = text_of(wire.name);
  message.file_version = text_of(wire.file_version);
  message.service_version = text_of(wire.service_version);
  message.host = text_of(wire.host);
  message.pid = wire.pid;
  message.is_serving = wire.is_serving != 0;
  message.kinematics = text_of(wire.kinematics);
  message.clock = text_of(wire.clock);
  message.cycle_ns = wire.cycle_ns;
  message.bridge_cycles = wire.bridge_cycles;
  message.joint_count = std::min<std::uint32_t>(wire.joint_count, kMaxJoints);
  for (std::size_t i = 0; i < kMaxJoints; ++i) from_wire(wire.joints[i], message.joints[i]);
  message.stage_drive_count = std::min<std::uint32_t>(wire.stage_drive_count, kStageDrives);
  for (std::size_t i = 0; i < kStageDrives; ++i) {
    from_wire(wire.stage_drives[i], message.stage_drives[i]);
  }
  message.max_feed_mm_per_min = wire.max_feed_mm_per_min;
  message.tip_tolerance_mm = wire.tip_tolerance_mm;
  message.axis_tolerance_rad = wire.axis_tolerance_rad;
  message.tool_length_mm = wire.tool_length_mm;
  std::copy_n(wire.frame_rotation, 9, message.frame_rotation.begin());
  std::copy_n(wire.frame_origin_mm, 3, message.frame_origin_mm.begin());
  message.machine_file = text_of(wire.machine_file);
  message.tool_file = text_of(wire.tool_file);
}

void to_wire(const Latency& message, meridian_wire_Latency& wire) noexcept {
  wire.service_id = message.service_id;
  wire.time_ns = message.time_ns;
  const std::size_t count = std::min(message.histograms.size(), kMaxHistograms);
  wire.count = static_cast<std::uint32_t>(count);
  std::memset(wire.histograms, 0, sizeof wire.histograms);
  for (std::size_t i = 0; i < count; ++i) {
    const HistogramSnapshot& from = message.histograms[i];
    meridian_wire_Histogram& to = wire.histograms[i];
    copy_text(from.name, to.name);
    to.count = from.count;
    to.p50_ns = from.p50_ns;
    to.p99_ns = from.p99_ns;
    to.p999_ns = from.p999_ns;
    to.max_ns = from.max_ns;
    copy_array(from.buckets, to.buckets);
  }
}

void from_wire(const meridian_wire_Latency& wire, Latency& message) {
  message.service_id = wire.service_id;
  message.time_ns = wire.time_ns;
  message.histograms.resize(std::min<std::size_t>(wire.count, kMaxHistograms));
  for (std::size_t i = 0; i < message.histograms.size(); ++i) {
    const meridian_wire_Histogram& from = wire.histograms[i];
    HistogramSnapshot& to = message.histograms[i];
    to.name = text_of(from.name);
    to.count = from.count;
    to.p50_ns = from.p50_ns;
    to.p99_ns = from.p99_ns;
    to.p999_ns = from.p999_ns;
    to.max_ns = from.max_ns;
    copy_array(from.buckets, to.buckets);
  }
}

}  // namespace meridian::dds
