// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert/convert.hpp"
#include "service/transport/convert/wire_fields.hpp"

namespace meridian::dds {
namespace {

template <class Convert, class Message, class Wire>
void setpoint_sample_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.setpoint.cycle, wire.cycle);
  convert(message.setpoint.due_ns, wire.due_ns);
  convert(message.setpoint.position, wire.position);
  convert(message.setpoint.velocity, wire.velocity);
  convert(message.setpoint.line, wire.line);
  convert(message.setpoint.epoch, wire.epoch);
  convert(message.setpoint.flags, wire.flags);
  convert(message.crc, wire.crc32c);
}

template <class Convert, class Message, class Wire>
void drive_command_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.drive, wire.drive);
  convert(message.controlword, wire.controlword);
  convert(message.mode, wire.mode);
  convert(message.epoch, wire.epoch);
  convert(message.service_id, wire.service_id);
  convert(message.sample, wire.sample);
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

template <class Convert, class Message, class Wire>
void drive_feedback_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.drive_group, wire.drive_group);
  convert(message.joint_mask, wire.joint_mask);
  convert(message.sample, wire.sample);
  convert(message.cycle_seen, wire.cycle_seen);
  convert(message.service_id, wire.service_id);
  convert(message.position, wire.position);
  convert(message.statusword, wire.statusword);
  convert(message.error, wire.error);
  convert(message.referenced_mask, wire.referenced_mask);
  input_bits(convert, message, wire);
  convert(message.probe, wire.probe);
  convert(message.mode_display, wire.mode_display);
}

template <class Convert, class Message, class Wire>
void action_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.id, wire.id);
  convert(message.service_id, wire.service_id);
  convert(message.sequence, wire.block);
  convert(message.line, wire.line);
  convert(message.kind, wire.kind);
  convert(message.value, wire.value);
  convert(message.text, wire.text);
}

template <class Convert, class Message, class Wire>
void action_done_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.id, wire.id);
  convert(message.service_id, wire.service_id);
  convert(message.is_done, wire.is_done);
  convert(message.text, wire.text);
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
