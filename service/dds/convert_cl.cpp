// SPDX-License-Identifier: Apache-2.0
#include "service/dds/convert.hpp"
#include "service/dds/wire_fields.hpp"

namespace meridian::dds {
namespace {

void to_wire(const ClBlock& block, meridian_wire_ClBlock& wire) noexcept {
  wire.number = block.sequence;
  wire.line = block.line;
  wire.kind = octet(block.kind);
  wire.feed_meaning = octet(block.feed_meaning);
  wire.action = octet(block.action);
  wire.is_arc = block.is_arc ? 1 : 0;
  copy_array(block.tip_mm, wire.tip_mm);
  copy_array(block.axis, wire.axis);
  copy_array(block.centre_mm, wire.centre_mm);
  copy_array(block.normal, wire.normal);
  wire.sweep_rad = block.sweep_rad;
  wire.feed = block.feed;
  wire.value = block.value;
  std::memcpy(wire.text, block.text, sizeof wire.text);
}

void from_wire(const meridian_wire_ClBlock& wire, ClBlock& block) noexcept {
  block.sequence = wire.number;
  block.line = wire.line;
  block.kind = static_cast<BlockKind>(wire.kind);
  block.feed_meaning = static_cast<FeedMeaning>(wire.feed_meaning);
  block.action = static_cast<ActionKind>(wire.action);
  block.is_arc = wire.is_arc != 0;
  copy_array(wire.tip_mm, block.tip_mm);
  copy_array(wire.axis, block.axis);
  copy_array(wire.centre_mm, block.centre_mm);
  copy_array(wire.normal, block.normal);
  block.sweep_rad = wire.sweep_rad;
  block.feed = wire.feed;
  block.value = wire.value;
  std::memcpy(block.text, wire.text, sizeof block.text);
}

}  // namespace

static_assert(kBatchBlocks == meridian_wire_kBatchBlocks);

void to_wire(const Batch& message, meridian_wire_ClBatch& wire) noexcept {
  wire.session = message.session;
  wire.first_sequence = message.first_sequence;
  wire.count = message.count;
  wire.is_end = message.is_end ? 1 : 0;
  wire.crc32c = message.crc;
  for (std::size_t i = 0; i < kBatchBlocks; ++i) to_wire(message.blocks[i], wire.blocks[i]);
}

void from_wire(const meridian_wire_ClBatch& wire, Batch& message) noexcept {
  message.session = wire.session;
  message.first_sequence = wire.first_sequence;
  message.count = wire.count;
  message.is_end = wire.is_end != 0;
  message.crc = wire.crc32c;
  for (std::size_t i = 0; i < kBatchBlocks; ++i) from_wire(wire.blocks[i], message.blocks[i]);
}

void to_wire(const SessionRequest& message, meridian_wire_ClSession& wire) noexcept {
  wire.session = message.session;
  wire.request = octet(message.request);
  copy_text(message.station, wire.station);
  copy_text(message.program, wire.program);
  wire.block_count = message.block_count;
  wire.tip_tolerance_mm = message.tip_tolerance_mm;
  wire.axis_tolerance_rad = message.axis_tolerance_rad;
  wire.policies = message.policies;
}

void from_wire(const meridian_wire_ClSession& wire, SessionRequest& message) {
  message.session = wire.session;
  message.request = static_cast<SessionRequestKind>(wire.request);
  message.station = text_of(wire.station);
  message.program = text_of(wire.program);
  message.block_count = wire.block_count;
  message.tip_tolerance_mm = wire.tip_tolerance_mm;
  message.axis_tolerance_rad = wire.axis_tolerance_rad;
  message.policies = wire.policies;
}

void to_wire(const Credit& message, meridian_wire_ClCredit& wire) noexcept {
  wire.session = message.session;
  wire.service_id = message.service_id;
  wire.next_sequence = message.next_sequence;
  wire.credits = message.credits;
  wire.verdict = octet(message.verdict);
  wire.verdict_sequence = message.verdict_sequence;
  wire.verdict_line = message.verdict_line;
  wire.verdict_joint = message.verdict_joint;
  wire.verdict_value = message.verdict_value;
  copy_text(message.text, wire.text);
}

void from_wire(const meridian_wire_ClCredit& wire, Credit& message) {
  message.session = wire.session;
  message.service_id = wire.service_id;
  message.next_sequence = wire.next_sequence;
  message.credits = wire.credits;
  message.verdict = static_cast<Verdict>(wire.verdict);
  message.verdict_sequence = wire.verdict_sequence;
  message.verdict_line = wire.verdict_line;
  message.verdict_joint = wire.verdict_joint;
  message.verdict_value = wire.verdict_value;
  message.text = text_of(wire.text);
}

}  // namespace meridian::dds
