// SPDX-License-Identifier: Apache-2.0
#include "attack/content.hpp"

#include <algorithm>
#include <cstdio>

namespace attack {
namespace {

constexpr std::uint8_t kFeedOverride = 7, kRapidOverride = 8, kSingleBlock = 11, kOptionalStop = 12,
                       kHold = 3;
constexpr std::uint8_t kReady = 2;
constexpr std::uint16_t kOperationEnabled = 0x27, kEnableOperation = 15;
constexpr double kFast_mm_per_s = 3500;
constexpr std::int64_t kFarFuture_ns = 4'000'000'000'000'000'000;

template <std::size_t N>
void put(char (&text)[N], const char* words) {
  std::snprintf(text, N, "%s", words);
}

/// Harmless to what is measured: overrides of 100 % and switches that are off.
std::uint8_t drawn_verb(std::uint64_t random) {
  constexpr std::uint8_t kVerbs[] = {kFeedOverride, kRapidOverride, kSingleBlock, kOptionalStop};
  return kVerbs[random % 4];
}

/// The operator's numbers that come next.
std::uint64_t next_request(const Words& words) {
  constexpr std::uint64_t kAhead = 8;
  return words.heard.command.request + 1 + words.number % kAhead;
}

}  // namespace

void fill(meridian_wire_ClBatch& sample, const Words& words) {
  const std::uint64_t session = words.heard.status.session;
  sample.session = words.is_forged && session != 0 ? session : words.own_id;
  sample.first_sequence =
      words.is_forged ? words.heard.credit.next_sequence + 1000 + words.number % 8 : words.number;
  sample.count = 1 + words.random % meridian_wire_kBatchBlocks;
  for (std::uint32_t i = 0; i < sample.count; ++i) {
    sample.blocks[i].number = sample.first_sequence + i;
    sample.blocks[i].line = i + 1;
    sample.blocks[i].axis[2] = 1;
  }
  sample.crc32c = crc_of(sample);
}

void fill(meridian_wire_ClSession& sample, const Words& words) {
  const std::uint64_t session = words.heard.status.session;
  const bool is_forged = words.is_forged && session != 0;
  // A close of somebody else's session is what a forger would want: it must have no effect.
  sample.session = is_forged ? session : words.own_id + ((words.number / 2) << 32U);
  sample.request = is_forged ? 1 : static_cast<std::uint8_t>(words.number % 2);
  put(sample.station, kOwnName);
  put(sample.program, "attack.cls");
}

void fill(meridian_wire_ClCredit& sample, const Words& words) {
  sample.session = words.is_forged ? words.heard.status.session : words.own_id;
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.next_sequence = words.heard.credit.next_sequence;
  sample.credits = 1;
  sample.verdict = 1;
}

void fill(meridian_wire_Command& sample, const Words& words) {
  const bool is_forged = words.is_forged && words.heard.command.operator_id != 0;
  sample.request = is_forged ? next_request(words) : words.number;
  sample.operator_id = is_forged ? words.heard.command.operator_id : words.own_id;
  put(sample.operator_name, kOwnName);
  sample.verb =
      words.verb == 255 ? drawn_verb(words.random) : static_cast<std::uint8_t>(words.verb);
  sample.epoch_seen = words.heard.status.epoch;
  sample.status_seen = words.heard.status.status_sequence;
  sample.service_id_seen = words.heard.status.service_id;
  sample.argument = sample.verb == kFeedOverride || sample.verb == kRapidOverride ? 1 : 0;
}

void fill(meridian_wire_Reply& sample, const Words& words) {
  sample.request = words.is_forged ? words.heard.command.request + words.number % 3 : words.number;
  sample.operator_id = words.is_forged ? words.heard.command.operator_id : words.own_id;
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.requester = words.heard.reply.requester;
  sample.verb = kHold;
  sample.is_accepted = 1;
  sample.state = kReady;
  put(sample.text, "hold accepted");
}

void fill(meridian_wire_Jog& sample, const Words& words) {
  const bool is_forged = words.is_forged && words.heard.command.operator_id != 0;
  sample.operator_id = is_forged ? words.heard.command.operator_id : words.own_id;
  sample.sample = is_forged ? words.heard.jog.sample + 1 + words.number % 4 : words.number;
  sample.status_seen = words.heard.status.status_sequence;
  sample.service_id_seen = words.heard.status.service_id;
  sample.epoch_seen = words.heard.status.epoch;
  sample.velocity = 10;
  sample.dead_man_ns = 200'000'000;
}

void fill(meridian_wire_Enabling& sample, const Words& words) {
  const bool is_forged = words.is_forged && words.heard.command.operator_id != 0;
  sample.operator_id = is_forged ? words.heard.command.operator_id : words.own_id;
  sample.sample = words.number;
  put(sample.operator_name, kOwnName);
  sample.device = static_cast<std::uint8_t>(words.number % 3);
}

void fill(meridian_wire_Setpoint& sample, const Words& words) {
  const meridian_wire_Setpoint& newest = words.heard.setpoint;
  sample = newest;
  sample.cycle = kMark + newest.cycle + words.number;
  sample.due_ns = monotonic_ns();
  const double phase = static_cast<double>(words.number % 1000) / 1000;
  sample.position[0] = newest.position[0] + 50 + 500 * phase;
  sample.velocity[0] = kFast_mm_per_s;
  sample.flags = 3;  // enabled and moving
  // The sum is no secret, and whose service it is every status says.
  sample.crc32c = crc_of(sample, words.is_forged ? words.heard.status.service_id : words.own_id);
}

void fill(meridian_wire_DriveCommand& sample, const Words& words) {
  sample.drive = static_cast<std::uint8_t>(words.number % 5);
  sample.controlword = kEnableOperation;
  sample.mode = 8;
  sample.epoch = words.heard.status.epoch;
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.sample = words.heard.drive_command.sample + 1000 + words.number;
}

void fill(meridian_wire_Feedback& sample, const Words& words) {
  const meridian_wire_Feedback& newest = words.heard.feedback;
  sample = newest;
  if (!words.is_forged) sample.drive_group = 66;
  sample.joint_mask = 0x1f;
  sample.sample = newest.sample + 1000 + words.number;
  sample.cycle_seen = words.heard.setpoint.cycle;
  sample.service_id = words.heard.status.service_id;
  for (double& position : sample.position) position += 100;
  for (auto& word : sample.statusword) word = kOperationEnabled;
  sample.referenced_mask = 0x1f;
  sample.is_emergency_stop = 0;
}

void fill(meridian_wire_Action& sample, const Words& words) {
  sample.id = words.is_forged ? words.heard.action.id + 1 : words.number;
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.line = 1;
  sample.kind = 1;
  sample.value = 1;
}

void fill(meridian_wire_ActionDone& sample, const Words& words) {
  sample.id = words.is_forged ? words.heard.action.id + words.number % 2 : words.number;
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.is_done = 1;
  put(sample.text, "done");
}

void fill(meridian_wire_Status& sample, const Words& words) {
  sample = words.heard.status;
  if (!words.is_forged) sample.service_id = words.own_id;
  sample.status_sequence += 1000 + words.number;
  sample.time_ns = monotonic_ns();
  sample.state = kReady;
  put(sample.message, "everything is fine");
}

void fill(meridian_wire_Machine& sample, const Words& words) {
  sample = words.heard.machine;
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.served_ns = kFarFuture_ns;
  sample.is_serving = 1;
  sample.pid = 1;
  put(sample.host, "elsewhere");
}

void fill(meridian_wire_Latency& sample, const Words& words) {
  sample.service_id = words.is_forged ? words.heard.status.service_id : words.own_id;
  sample.time_ns = monotonic_ns();
  sample.count = meridian_wire_kHistograms;
  for (auto& one : sample.histograms) {
    put(one.name, "lateness");
    put(one.buckets, "4000000000:18446744073709551615 7:1");
  }
}

}  // namespace attack
