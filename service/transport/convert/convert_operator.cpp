// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert/convert.hpp"
#include "service/transport/convert/wire_fields.hpp"

namespace meridian::dds {
namespace {

template <class Convert, class Message, class Wire>
void command_request_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.request, wire.request);
  convert(message.operator_id, wire.operator_id);
  convert(message.operator_name, wire.operator_name);
  convert(message.verb, wire.verb);
  convert(message.epoch_seen, wire.epoch_seen);
  convert(message.status_seen, wire.status_seen);
  convert(message.service_id_seen, wire.service_id_seen);
  convert(message.argument, wire.argument);
  convert(message.frame.word, wire.frame_word);
  convert(message.frame.frame.number, wire.frame_number);
  convert.name(message.frame.frame.name, wire.frame_name);
  convert(message.frame.frame.origin_mm, wire.frame_origin_mm);
  convert(message.frame.frame.rotation_deg, wire.frame_rotation_deg);
  convert(message.tools_seen, wire.tools_seen);
  convert.whole(message.tool_file, wire.tool_file);
  convert(message.limits.word, wire.limits_word);
  convert(message.limits.joint, wire.limits_joint);
  convert(message.limits.min, wire.limits_min);
  convert(message.limits.max, wire.limits_max);
  convert.name(message.limits.box.name, wire.limits_box_name);
  convert(message.limits.box.joints, wire.limits_box_joints);
  convert(message.limits.box.min, wire.limits_box_min);
  convert(message.limits.box.max, wire.limits_box_max);
}

template <class Convert, class Message, class Wire>
void reply_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.request, wire.request);
  convert(message.operator_id, wire.operator_id);
  convert(message.service_id, wire.service_id);
  convert(message.requester, wire.requester);
  convert(message.verb, wire.verb);
  convert(message.is_accepted, wire.is_accepted);
  convert(message.refusal, wire.refusal);
  convert(message.state, wire.state);
  convert(message.epoch, wire.epoch);
  convert(message.text, wire.text);
}

template <class Convert, class Message, class Wire>
void jog_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.operator_id, wire.operator_id);
  convert(message.sample, wire.sample);
  convert(message.status_seen, wire.status_seen);
  convert(message.service_id_seen, wire.service_id_seen);
  convert(message.epoch_seen, wire.epoch_seen);
  convert(message.frame, wire.frame);
  convert(message.joint, wire.joint);
  convert(message.velocity, wire.velocity);
  convert(message.distance, wire.distance);
  convert(message.dead_man_ns, wire.dead_man_ns);
}

template <class Convert, class Message, class Wire>
void enabling_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.operator_id, wire.operator_id);
  convert(message.sample, wire.sample);
  convert(message.operator_name, wire.operator_name);
  convert(message.device, wire.device);
  convert(message.service_id_seen, wire.service_id_seen);
}

}  // namespace

void to_wire(const CommandRequest& message, meridian_wire_Command& wire) noexcept {
  command_request_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Command& wire, CommandRequest& message) {
  command_request_fields(FromWire(), message, wire);
}

void to_wire(const Reply& message, meridian_wire_Reply& wire) noexcept {
  reply_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Reply& wire, Reply& message) {
  reply_fields(FromWire(), message, wire);
}

void to_wire(const Jog& message, meridian_wire_Jog& wire) noexcept {
  jog_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Jog& wire, Jog& message) noexcept {
  jog_fields(FromWire(), message, wire);
}

void to_wire(const Enabling& message, meridian_wire_Enabling& wire) noexcept {
  enabling_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_Enabling& wire, Enabling& message) {
  enabling_fields(FromWire(), message, wire);
}

}  // namespace meridian::dds
