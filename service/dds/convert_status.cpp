// SPDX-License-Identifier: Apache-2.0
#include "service/dds/convert.hpp"
#include "service/dds/wire_fields.hpp"

namespace meridian::dds {

static_assert(kMaxHistograms == meridian_wire_kHistograms);
static_assert(kHistogramBuckets == meridian_wire_kHistogramBuckets);

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
