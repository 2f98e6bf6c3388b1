// SPDX-License-Identifier: Apache-2.0
#include "service/dds/convert.hpp"
#include "service/dds/wire_fields.hpp"

namespace meridian::dds {

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

}  // namespace meridian::dds
