// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert.hpp"
#include "service/transport/wire_fields.hpp"

namespace meridian::dds {
namespace {

template <class Way, class Message, class Wire>
void setpoint_sample_fields(Way way, Message& message, Wire& wire) {
  way(message.setpoint.cycle, wire.cycle);
  way(message.setpoint.due_ns, wire.due_ns);
  way(message.setpoint.position, wire.position);
  way(message.setpoint.velocity, wire.velocity);
  way(message.setpoint.line, wire.line);
  way(message.setpoint.epoch, wire.epoch);
  way(message.setpoint.flags, wire.flags);
  way(message.crc, wire.crc32c);
}

template <class Way, class Message, class Wire>
void drive_command_fields(Way way, Message& message, Wire& wire) {
  way(message.drive, wire.drive);
  way(message.controlword, wire.controlword);
  way(message.mode, wire.mode);
  way(message.epoch, wire.epoch);
  way(message.service_id, wire.service_id);
  way(message.sample, wire.sample);
}

/// Two inputs share an octet: a guard is bit 1, the stop input any other.
constexpr std::uint8_t kStopBit = 1, kGuardBit = 2;

template <class Message, class Wire>
void input_bits(ToWire /*way*/, const Message& message, Wire& wire) {
  wire.is_emergency_stop = static_cast<std::uint8_t>((message.is_emergency_stop ? kStopBit : 0) |
                                                     (message.is_guard_open ? kGuardBit : 0));
}
template <class Message, class Wire>
void input_bits(FromWire /*way*/, Message& message, const Wire& wire) {
  message.is_emergency_stop = (wire.is_emergency_stop & ~kGuardBit) != 0;
  message.is_guard_open = (wire.is_emergency_stop & kGuardBit) != 0;
}

template <class Way, class Message, class Wire>
void drive_feedback_fields(Way way, Message& message, Wire& wire) {
  way(message.drive_group, wire.drive_group);
  way(message.joint_mask, wire.joint_mask);
  way(message.sample, wire.sample);
  way(message.cycle_seen, wire.cycle_seen);
  way(message.service_id, wire.service_id);
  way(message.position, wire.position);
  way(message.statusword, wire.statusword);
  way(message.error, wire.error);
  way(message.referenced_mask, wire.referenced_mask);
  input_bits(way, message, wire);
  way(message.probe, wire.probe);
  way(message.mode_display, wire.mode_display);
}

template <class Way, class Message, class Wire>
void action_fields(Way way, Message& message, Wire& wire) {
  way(message.id, wire.id);
  way(message.service_id, wire.service_id);
  way(message.sequence, wire.block);
  way(message.line, wire.line);
  way(message.kind, wire.kind);
  way(message.value, wire.value);
  way(message.text, wire.text);
}

template <class Way, class Message, class Wire>
void action_done_fields(Way way, Message& message, Wire& wire) {
  way(message.id, wire.id);
  way(message.service_id, wire.service_id);
  way(message.is_done, wire.is_done);
  way(message.text, wire.text);
}

}  // namespace

void to_wire(const SetpointSample& message, meridian_wire_Setpoint& wire) noexcept {
  setpoint_sample_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Setpoint& wire, SetpointSample& message) noexcept {
  setpoint_sample_fields(FromWire(), message, wire);
}

void to_wire(const DriveCommand& message, meridian_wire_DriveCommand& wire) noexcept {
  drive_command_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_DriveCommand& wire, DriveCommand& message) noexcept {
  drive_command_fields(FromWire(), message, wire);
}

void to_wire(const DriveFeedback& message, meridian_wire_Feedback& wire) noexcept {
  drive_feedback_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Feedback& wire, DriveFeedback& message) noexcept {
  drive_feedback_fields(FromWire(), message, wire);
}

void to_wire(const Action& message, meridian_wire_Action& wire) noexcept {
  action_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Action& wire, Action& message) {
  action_fields(FromWire(), message, wire);
}

void to_wire(const ActionDone& message, meridian_wire_ActionDone& wire) noexcept {
  action_done_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_ActionDone& wire, ActionDone& message) {
  action_done_fields(FromWire(), message, wire);
}

}  // namespace meridian::dds
