// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "attack/samples.hpp"

/// What samples say, topic by topic.
namespace attack {

/// Ids of operators, sessions and services that are ours begin so.
inline constexpr std::uint64_t kOwnIds = 0x6660'0000ULL;
[[nodiscard]] constexpr bool is_own(std::uint64_t id) noexcept { return (id >> 16U) == 0x6660U; }

/// What operators and stations of ours are called, in whatever name they speak.
inline constexpr const char* kOwnName = "attacker";

/// What a sample is made of.
struct Words {
  const Heard& heard;
  bool is_forged;
  std::uint64_t number;  ///< counts samples, from 1
  std::uint64_t own_id;
  int verb;  ///< of commands; 255: drawn
  std::uint64_t random;
};

// Each with zeros in the fields that are not named.
void fill(meridian_wire_ClBatch& sample, const Words& words);
void fill(meridian_wire_ClSession& sample, const Words& words);
void fill(meridian_wire_ClCredit& sample, const Words& words);
void fill(meridian_wire_Command& sample, const Words& words);
void fill(meridian_wire_Reply& sample, const Words& words);
void fill(meridian_wire_Jog& sample, const Words& words);
void fill(meridian_wire_Enabling& sample, const Words& words);
void fill(meridian_wire_Setpoint& sample, const Words& words);
void fill(meridian_wire_DriveCommand& sample, const Words& words);
void fill(meridian_wire_Feedback& sample, const Words& words);
void fill(meridian_wire_Action& sample, const Words& words);
void fill(meridian_wire_ActionDone& sample, const Words& words);
void fill(meridian_wire_Status& sample, const Words& words);
void fill(meridian_wire_Machine& sample, const Words& words);
void fill(meridian_wire_Latency& sample, const Words& words);

template <std::size_t N, class Visit>
void text_of(char (&text)[N], const Visit& visit) {
  visit(text, N);
}

/// Calls visit(char*, size) for each text of a sample.
template <class Sample, class Visit>
void for_each_text(Sample& sample, const Visit& visit) {
  if constexpr (requires { sample.operator_name; }) text_of(sample.operator_name, visit);
  if constexpr (requires { sample.text; }) text_of(sample.text, visit);
  if constexpr (requires { sample.station; }) text_of(sample.station, visit);
  if constexpr (requires { sample.program; }) text_of(sample.program, visit);
  if constexpr (requires { sample.options; }) text_of(sample.options, visit);
  if constexpr (requires { sample.stalled_reader; }) text_of(sample.stalled_reader, visit);
  if constexpr (requires { sample.message; }) text_of(sample.message, visit);
  if constexpr (requires { sample.name; }) text_of(sample.name, visit);
  if constexpr (requires { sample.file_version; }) text_of(sample.file_version, visit);
  if constexpr (requires { sample.service_version; }) text_of(sample.service_version, visit);
  if constexpr (requires { sample.host; }) text_of(sample.host, visit);
  if constexpr (requires { sample.kinematics; }) text_of(sample.kinematics, visit);
  if constexpr (requires { sample.clock; }) text_of(sample.clock, visit);
  if constexpr (requires { sample.machine_file; }) text_of(sample.machine_file, visit);
  if constexpr (requires { sample.tool_file; }) text_of(sample.tool_file, visit);
  if constexpr (requires { sample.blocks; }) {
    for (auto& block : sample.blocks) text_of(block.text, visit);
  }
  if constexpr (requires { sample.joints[0].name; }) {
    for (auto& joint : sample.joints) text_of(joint.name, visit);
    for (auto& drive : sample.stage_drives) text_of(drive.name, visit);
  }
  if constexpr (requires { sample.histograms; }) {
    for (auto& one : sample.histograms) {
      text_of(one.name, visit);
      text_of(one.buckets, visit);
    }
  }
}

}  // namespace attack
