// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert.hpp"
#include "service/transport/wire_fields.hpp"

namespace meridian::dds {
namespace {

static_assert(kBatchBlocks == meridian_wire_kBatchBlocks);
static_assert(kMaxOptions + 1 == sizeof(meridian_wire_ClSession::options));

template <class Way, class Message, class Wire>
void cl_block_fields(Way way, Message& message, Wire& wire) {
  way(message.sequence, wire.number);
  way(message.line, wire.line);
  way(message.kind, wire.kind);
  way(message.feed_meaning, wire.feed_meaning);
  way(message.action, wire.action);
  way(message.is_arc, wire.is_arc);
  way(message.tip_mm, wire.tip_mm);
  way(message.axis, wire.axis);
  way(message.centre_mm, wire.centre_mm);
  way(message.normal, wire.normal);
  way(message.sweep_rad, wire.sweep_rad);
  way(message.feed, wire.feed);
  way(message.value, wire.value);
  way(message.text, wire.text);
}

template <class Way, class Message, class Wire>
void batch_fields(Way way, Message& message, Wire& wire) {
  way(message.session, wire.session);
  way(message.first_sequence, wire.first_sequence);
  way(message.count, wire.count);
  way(message.is_end, wire.is_end);
  way(message.crc, wire.crc32c);
  for (std::size_t i = 0; i < kBatchBlocks; ++i)
    cl_block_fields(way, message.blocks[i], wire.blocks[i]);
}

template <class Way, class Message, class Wire>
void session_request_fields(Way way, Message& message, Wire& wire) {
  way(message.session, wire.session);
  way(message.request, wire.request);
  way(message.station, wire.station);
  way(message.program, wire.program);
  way(message.block_count, wire.block_count);
  way(message.tip_tolerance_mm, wire.tip_tolerance_mm);
  way(message.axis_tolerance_rad, wire.axis_tolerance_rad);
  way(message.policies, wire.policies);
  way(message.options, wire.options);
  way(message.file_checksum, wire.file_checksum);
  way(message.from_line, wire.from_line);
  way(message.frame, wire.frame);
  way(message.tools, wire.tools);
  way(message.limits, wire.limits);
  way(message.first_joints, wire.first_joints);
}

template <class Way, class Message, class Wire>
void credit_fields(Way way, Message& message, Wire& wire) {
  way(message.session, wire.session);
  way(message.service_id, wire.service_id);
  way(message.next_sequence, wire.next_sequence);
  way(message.credits, wire.credits);
  way(message.verdict, wire.verdict);
  way(message.verdict_sequence, wire.verdict_sequence);
  way(message.verdict_line, wire.verdict_line);
  way(message.verdict_joint, wire.verdict_joint);
  way(message.verdict_value, wire.verdict_value);
  way(message.text, wire.text);
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
