// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert/convert.hpp"
#include "service/transport/convert/wire_fields.hpp"

namespace meridian::dds {
namespace {

static_assert(kBatchBlocks == meridian_wire_kBatchBlocks);
static_assert(kMaxOptions + 1 == sizeof(meridian_wire_ClSession::options));

template <class Convert, class Message, class Wire>
void cl_block_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.sequence, wire.number);
  convert(message.line, wire.line);
  convert(message.kind, wire.kind);
  convert(message.feed_meaning, wire.feed_meaning);
  convert(message.action, wire.action);
  convert(message.is_arc, wire.is_arc);
  convert(message.tip_mm, wire.tip_mm);
  convert(message.axis, wire.axis);
  convert(message.centre_mm, wire.centre_mm);
  convert(message.normal, wire.normal);
  convert(message.sweep_rad, wire.sweep_rad);
  convert(message.feed, wire.feed);
  convert(message.value, wire.value);
  convert(message.text, wire.text);
}

template <class Convert, class Message, class Wire>
void batch_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.session, wire.session);
  convert(message.first_sequence, wire.first_sequence);
  convert(message.count, wire.count);
  convert(message.is_end, wire.is_end);
  convert(message.crc, wire.crc32c);
  for (std::size_t i = 0; i < kBatchBlocks; ++i)
    cl_block_fields(convert, message.blocks[i], wire.blocks[i]);
}

template <class Convert, class Message, class Wire>
void session_request_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.session, wire.session);
  convert(message.request, wire.request);
  convert(message.station, wire.station);
  convert(message.program, wire.program);
  convert(message.block_count, wire.block_count);
  convert(message.tip_tolerance_mm, wire.tip_tolerance_mm);
  convert(message.axis_tolerance_rad, wire.axis_tolerance_rad);
  convert(message.policies, wire.policies);
  convert(message.options, wire.options);
  convert(message.file_checksum, wire.file_checksum);
  convert(message.from_line, wire.from_line);
  convert(message.frame, wire.frame);
  convert(message.tools, wire.tools);
  convert(message.limits, wire.limits);
  convert(message.first_joints, wire.first_joints);
}

template <class Convert, class Message, class Wire>
void credit_fields(Convert convert, Message& message, Wire& wire) {
  convert(message.session, wire.session);
  convert(message.service_id, wire.service_id);
  convert(message.next_sequence, wire.next_sequence);
  convert(message.credits, wire.credits);
  convert(message.verdict, wire.verdict);
  convert(message.verdict_sequence, wire.verdict_sequence);
  convert(message.verdict_line, wire.verdict_line);
  convert(message.verdict_joint, wire.verdict_joint);
  convert(message.verdict_value, wire.verdict_value);
  convert(message.text, wire.text);
}

}  // namespace

void to_wire(const Batch& message, meridian_wire_ClBatch& wire) noexcept {
  batch_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_ClBatch& wire, Batch& message) noexcept {
  batch_fields(FromWire(), message, wire);
}

void to_wire(const SessionRequest& message, meridian_wire_ClSession& wire) noexcept {
  session_request_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_ClSession& wire, SessionRequest& message) {
  session_request_fields(FromWire(), message, wire);
}

void to_wire(const Credit& message, meridian_wire_ClCredit& wire) noexcept {
  credit_fields(ToWire(), message, wire);
}

void from_wire(const meridian_wire_ClCredit& wire, Credit& message) {
  credit_fields(FromWire(), message, wire);
}

}  // namespace meridian::dds
