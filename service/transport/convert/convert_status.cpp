// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "service/transport/convert/convert.hpp"
#include "service/transport/convert/wire_fields.hpp"

namespace meridian::dds {
namespace {

static_assert(kMaxHistograms == meridian_wire_kHistograms);
constexpr WorkFrame kNoFrame{};
static_assert(WorkFrames::kMax == meridian_wire_kWorkFrames);

template <class Convert, class Message, class Wire>
void status_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.service_id, wire.service_id);
  convert(message.status_sequence, wire.status_sequence);
  convert(message.time_ns, wire.time_ns);
  convert(message.cycle, wire.cycle);
  convert(message.state, wire.state);
  convert(message.realtime_mode, wire.realtime_mode);
  convert(message.is_secured, wire.is_secured);
  convert(message.is_open_network, wire.is_open_network);
  convert(message.is_enabling_required, wire.is_enabling_required);
  convert(message.enabling_devices, wire.enabling_devices);
  convert(message.is_auxiliary_ignored, wire.is_auxiliary_ignored);
  convert(message.alarm, wire.alarm);
  convert(message.alarm_joint, wire.alarm_joint);
  convert(message.epoch, wire.epoch);
  convert(message.alarm_line, wire.alarm_line);
  convert(message.alarm_value, wire.alarm_value);
  convert(message.session, wire.session);
  convert(message.station, wire.station);
  convert(message.program, wire.program);
  convert(message.block_count, wire.block_count);
  convert(message.block, wire.block);
  convert(message.line, wire.line);
  convert(message.motion, wire.motion);
  convert(message.branch, wire.branch);
  convert(message.is_at_pole, wire.is_at_pole);
  convert(message.limiting_joint, wire.limiting_joint);
  convert(message.feed_programmed_mm_per_min, wire.feed_programmed_mm_per_min);
  convert(message.feed_achieved_mm_per_min, wire.feed_achieved_mm_per_min);
  convert(message.feed_override, wire.feed_override);
  convert(message.rapid_override, wire.rapid_override);
  convert(message.is_single_block, wire.is_single_block);
  convert(message.stops_at_optional, wire.stops_at_optional);
  convert(message.is_dry_run, wire.is_dry_run);
  convert(message.work_frame, wire.work_frame);
  convert(message.frame, wire.frame);
  convert(message.tools, wire.tools);
  convert(message.limits, wire.limits);
  convert(message.tool, wire.tool);
  convert(message.tool_length_mm, wire.tool_length_mm);
  convert(message.rate, wire.rate);
  convert(message.plan_time_s, wire.plan_time_s);
  convert(message.joints, wire.joints);
  convert(message.drives_enabled_mask, wire.drives_enabled_mask);
  convert(message.drives_fault_mask, wire.drives_fault_mask);
  convert(message.probe, wire.probe);
  convert(message.is_guard_open, wire.is_guard_open);
  convert(message.stops, wire.stops);
  convert(message.contacts, wire.contacts);
  convert(message.contact_periods, wire.contact_periods);
  convert(message.contact_joints, wire.contact_joints);
  convert(message.contact_free_joints, wire.contact_free_joints);
  convert(message.blocks_received, wire.blocks_received);
  convert(message.blocks_done, wire.blocks_done);
  convert(message.blocks_queued, wire.blocks_queued);
  convert(message.pieces_queued, wire.pieces_queued);
  convert(message.planned_s, wire.planned_s);
  convert(message.stop_time_s, wire.stop_time_s);
  convert(message.stop_distance_mm, wire.stop_distance_mm);
  convert(message.cycles_run, wire.cycles_run);
  convert(message.periods_lost, wire.periods_lost);
  convert(message.starvations, wire.starvations);
  convert(message.batches_dropped, wire.batches_dropped);
  convert(message.batches_lost, wire.batches_lost);
  convert(message.setpoints_overrun, wire.setpoints_overrun);
  convert(message.records_overrun, wire.records_overrun);
  convert(message.events_overrun, wire.events_overrun);
  convert(message.commands_dropped, wire.commands_dropped);
  convert(message.replies_dropped, wire.replies_dropped);
  convert(message.stalled_reader, wire.stalled_reader);
  convert(message.message, wire.message);
}

template <class Convert, class Message, class Wire>
void joint_info_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.name, wire.name);
  convert(message.is_rotary, wire.is_rotary);
  convert(message.is_endless, wire.is_endless);
  convert(message.drive, wire.drive);
  convert(message.limits.travel_min, wire.travel_min);
  convert(message.limits.travel_max, wire.travel_max);
  convert(message.limits.velocity, wire.velocity);
  convert(message.limits.acceleration, wire.acceleration);
  convert(message.limits.jerk, wire.jerk);
  convert(message.limits.fault_acceleration, wire.fault_acceleration);
  convert(message.limits.fault_jerk, wire.fault_jerk);
  convert(message.limits.following_error, wire.following_error);
  convert(message.home, wire.home);
}

template <class Convert, class Message, class Wire>
void work_frame_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.number, wire.number);
  convert.name(message.name, wire.name);
  convert(message.origin_mm, wire.origin_mm);
  convert(message.rotation_deg, wire.rotation_deg);
}

template <class Convert, class Message, class Wire>
void machine_info_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.service_id, wire.service_id);
  convert(message.served_ns, wire.served_ns);
  convert(message.name, wire.name);
  convert(message.file_version, wire.file_version);
  convert(message.service_version, wire.service_version);
  convert(message.host, wire.host);
  convert(message.pid, wire.pid);
  convert(message.is_serving, wire.is_serving);
  convert(message.kinematics, wire.kinematics);
  convert(message.clock, wire.clock);
  convert(message.cycle_ns, wire.cycle_ns);
  convert(message.bridge_cycles, wire.bridge_cycles);
  convert(message.joint_count, wire.joint_count);
  for (std::size_t i = 0; i < kMaxJoints; ++i)
    joint_info_fields(convert, message.joints[i], wire.joints[i]);
  convert(message.stage_drive_count, wire.stage_drive_count);
  for (std::size_t i = 0; i < kStageDrives; ++i) {
    joint_info_fields(convert, message.stage_drives[i], wire.stage_drives[i]);
  }
  convert(message.max_feed_mm_per_min, wire.max_feed_mm_per_min);
  convert(message.tip_tolerance_mm, wire.tip_tolerance_mm);
  convert(message.axis_tolerance_rad, wire.axis_tolerance_rad);
  convert(message.tool_length_mm, wire.tool_length_mm);
  convert(message.frame_rotation, wire.frame_rotation);
  convert(message.frame_origin_mm, wire.frame_origin_mm);
  convert(message.work_frame, wire.work_frame);
  convert.whole(message.machine_file, wire.machine_file);
  convert.whole(message.tool_file, wire.tool_file);
}

template <class Convert, class Box, class Wire>
void keep_out_box_fields(Convert convert, Box& box, Wire& wire) {
  convert.name(box.name, wire.name);
  convert(box.joints, wire.joints);
  convert(box.min, wire.min);
  convert(box.max, wire.max);
}

template <class Convert, class Box, class Wire>
void tip_box_fields(Convert convert, Box& box, Wire& wire) {
  convert(box.is_set, wire.has_tip_box);
  convert(box.min, wire.tip_box_min_mm);
  convert(box.max, wire.tip_box_max_mm);
}

void soft_limits_to_wire(const SoftLimits& limits, meridian_wire_Machine& wire) noexcept {
  wire.soft_limits_mask = 0;
  for (std::size_t i = 0; i < limits.rows().size(); ++i) {
    const SoftLimits::Row& row = limits.rows()[i];
    if (row.is_set) wire.soft_limits_mask |= 1U << i;
    wire.soft_limits_min[i] = row.min;
    wire.soft_limits_max[i] = row.max;
  }
  const auto boxes = limits.keep_out().boxes();
  wire.keep_out_count = static_cast<std::uint32_t>(boxes.size());
  for (std::size_t i = 0; i < std::size_t{KeepOut::kMax}; ++i) {
    wire.keep_out[i] = {};
    if (i < boxes.size()) keep_out_box_fields(ToWire(), boxes[i], wire.keep_out[i]);
  }
  tip_box_fields(ToWire(), limits.tip_box(), wire);
}

void soft_limits_from_wire(const meridian_wire_Machine& wire, SoftLimits& limits) {
  limits = {};
  for (std::size_t i = 0; i < limits.rows().size(); ++i) {
    const bool is_set = (wire.soft_limits_mask >> i & 1U) != 0;
    if (is_set) limits.put(i, wire.soft_limits_min[i], wire.soft_limits_max[i]);
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(wire.keep_out_count, KeepOut::kMax); ++i) {
    KeepOutBox box;
    keep_out_box_fields(FromWire(), box, wire.keep_out[i]);
    (void)limits.put(box);
  }
  TipBox tip;
  tip_box_fields(FromWire(), tip, wire);
  limits.put(tip);
}

/// "number:count number:count ..." of the buckets that are not empty. What does not fit is left
/// out, the fewest counts being at the far end.
template <std::size_t N>
void print_buckets(const Histogram& histogram, char (&text)[N]) noexcept {
  constexpr std::size_t kLongest = 32;
  char* at = text;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
    if (histogram.bucket(i) == 0) continue;
    if (static_cast<std::size_t>(text + N - at) < kLongest) break;
    if (at != text) *at++ = ' ';
    at = std::to_chars(at, text + N, i).ptr;
    *at++ = ':';
    at = std::to_chars(at, text + N, histogram.bucket(i)).ptr;
  }
  *at = '\0';
}

void read_buckets(std::string_view text, Histogram& histogram) noexcept {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    std::size_t index = 0;
    std::uint64_t count = 0;
    const auto number = std::from_chars(at, end, index);
    if (number.ec != std::errc() || number.ptr == end || *number.ptr != ':') return;
    const auto counted = std::from_chars(number.ptr + 1, end, count);
    if (counted.ec != std::errc()) return;
    histogram.restore_bucket(index, count);
    if (counted.ptr == end) return;
    at = counted.ptr + 1;
  }
}

void histogram_to_wire(const NamedHistogram& message, meridian_wire_Histogram& wire) noexcept {
  const Histogram& histogram = message.histogram;
  ToWire()(message.name, wire.name);
  wire.count = histogram.count();
  wire.sum_ns = histogram.sum_ns();
  wire.p50_ns = histogram.percentile_ns(0.5);
  wire.p99_ns = histogram.percentile_ns(0.99);
  wire.p999_ns = histogram.percentile_ns(0.999);
  wire.max_ns = histogram.max_ns();
  print_buckets(histogram, wire.buckets);
}

void histogram_from_wire(const meridian_wire_Histogram& wire, NamedHistogram& message) {
  FromWire()(message.name, wire.name);
  message.histogram.clear();
  read_buckets({wire.buckets, ::strnlen(wire.buckets, sizeof wire.buckets)}, message.histogram);
  message.histogram.restore_sum_and_max(wire.sum_ns, wire.max_ns);
}

}  // namespace

void to_wire(const Status& message, meridian_wire_Status& wire) noexcept {
  status_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Status& wire, Status& message) {
  status_fields(FromWire(), message, wire);
}

void to_wire(const MachineInfo& message, meridian_wire_Machine& wire) noexcept {
  machine_info_fields(ToWire(), message, wire);
  const std::size_t count = std::min<std::size_t>(message.work_frames.size(), WorkFrames::kMax);
  wire.work_frame_count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < WorkFrames::kMax; ++i) {
    work_frame_fields(ToWire(), i < count ? message.work_frames[i] : kNoFrame, wire.work_frames[i]);
  }
  soft_limits_to_wire(message.soft_limits, wire);
}

void from_wire(const meridian_wire_Machine& wire, MachineInfo& message) {
  machine_info_fields(FromWire(), message, wire);
  message.joint_count = std::min<std::uint32_t>(message.joint_count, kMaxJoints);
  message.stage_drive_count = std::min<std::uint32_t>(message.stage_drive_count, kStageDrives);
  message.work_frames.resize(std::min<std::size_t>(wire.work_frame_count, WorkFrames::kMax));
  for (std::size_t i = 0; i < message.work_frames.size(); ++i) {
    work_frame_fields(FromWire(), message.work_frames[i], wire.work_frames[i]);
  }
  soft_limits_from_wire(wire, message.soft_limits);
}

void to_wire(const Latency& message, meridian_wire_Latency& wire) noexcept {
  wire.service_id = message.service_id;
  wire.time_ns = message.time_ns;
  const std::size_t count = std::min(message.histograms.size(), kMaxHistograms);
  wire.count = static_cast<std::uint32_t>(count);
  std::memset(wire.histograms, 0, sizeof wire.histograms);
  for (std::size_t i = 0; i < count; ++i) {
    histogram_to_wire(message.histograms[i], wire.histograms[i]);
  }
}

void from_wire(const meridian_wire_Latency& wire, Latency& message) {
  message.service_id = wire.service_id;
  message.time_ns = wire.time_ns;
  message.histograms.resize(std::min<std::size_t>(wire.count, kMaxHistograms));
  for (std::size_t i = 0; i < message.histograms.size(); ++i) {
    histogram_from_wire(wire.histograms[i], message.histograms[i]);
  }
}

}  // namespace meridian::dds
