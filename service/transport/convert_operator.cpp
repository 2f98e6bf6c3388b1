// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert.hpp"
#include "service/transport/wire_fields.hpp"

namespace meridian::dds {
namespace {

template <class Way, class Message, class Wire>
void command_request_fields(Way way, Message& message, Wire& wire) {
  way(message.request, wire.request);
  way(message.operator_id, wire.operator_id);
  way(message.operator_name, wire.operator_name);
  way(message.verb, wire.verb);
  way(message.epoch_seen, wire.epoch_seen);
  way(message.status_seen, wire.status_seen);
  way(message.service_id_seen, wire.service_id_seen);
  way(message.argument, wire.argument);
  way(message.frame.word, wire.frame_word);
  way(message.frame.frame.number, wire.frame_number);
  way.name(message.frame.frame.name, wire.frame_name);
  way(message.frame.frame.origin_mm, wire.frame_origin_mm);
  way(message.frame.frame.rotation_deg, wire.frame_rotation_deg);
  way(message.tools_seen, wire.tools_seen);
  way.whole(message.tool_file, wire.tool_file);
  way(message.limits.word, wire.limits_word);
  way(message.limits.joint, wire.limits_joint);
  way(message.limits.min, wire.limits_min);
  way(message.limits.max, wire.limits_max);
  way.name(message.limits.box.name, wire.limits_box_name);
  way(message.limits.box.joints, wire.limits_box_joints);
  way(message.limits.box.min, wire.limits_box_min);
  way(message.limits.box.max, wire.limits_box_max);
}

template <class Way, class Message, class Wire>
void reply_fields(Way way, Message& message, Wire& wire) {
  way(message.request, wire.request);
  way(message.operator_id, wire.operator_id);
  way(message.service_id, wire.service_id);
  way(message.requester, wire.requester);
  way(message.verb, wire.verb);
  way(message.is_accepted, wire.is_accepted);
  way(message.refusal, wire.refusal);
  way(message.state, wire.state);
  way(message.epoch, wire.epoch);
  way(message.text, wire.text);
}

template <class Way, class Message, class Wire>
void jog_fields(Way way, Message& message, Wire& wire) {
  way(message.operator_id, wire.operator_id);
  way(message.sample, wire.sample);
  way(message.status_seen, wire.status_seen);
  way(message.service_id_seen, wire.service_id_seen);
  way(message.epoch_seen, wire.epoch_seen);
  way(message.frame, wire.frame);
  way(message.joint, wire.joint);
  way(message.velocity, wire.velocity);
  way(message.distance, wire.distance);
  way(message.dead_man_ns, wire.dead_man_ns);
}

template <class Way, class Message, class Wire>
void enabling_fields(Way way, Message& message, Wire& wire) {
  way(message.operator_id, wire.operator_id);
  way(message.sample, wire.sample);
  way(message.operator_name, wire.operator_name);
  way(message.device, wire.device);
  way(message.service_id_seen, wire.service_id_seen);
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
