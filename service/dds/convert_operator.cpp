// SPDX-License-Identifier: Apache-2.0
#include "service/dds/convert.hpp"
#include "service/dds/wire_fields.hpp"

namespace meridian::dds {

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

}  // namespace meridian::dds
