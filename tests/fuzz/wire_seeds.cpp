// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "fuzz/fuzz_targets.hpp"
#include "fuzz/wire_samples.hpp"
#include "service/dds/convert.hpp"
#include "support/programs.hpp"

namespace meridian::fuzz {
namespace {

template <class Wire, class Message>
void append(std::vector<std::uint8_t>& seed, SampleType type, const Message& message) {
  static Wire wire;
  wire = {};
  dds::to_wire(message, wire);
  seed.push_back(type);
  if (type == kFeedback) seed.push_back(1);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&wire);
  seed.insert(seed.end(), bytes, bytes + sizeof wire);
}

}  // namespace

Seeds wire_seeds() {
  Seeds seeds;
  const auto add = [&seeds](const auto& fill) { fill(seeds.emplace_back()); };
  add([](auto& seed) {
    append<meridian_wire_ClBatch>(seed, kRawBatch, test::good_batch(1, 0, 32));
    append<meridian_wire_ClBatch>(seed, kRawBatch, test::good_batch(1, 32, 2, true));
  });
  add([](auto& seed) {
    static meridian_wire_ClBatch wire;
    dds::to_wire(test::good_batch(1, 0, 3), wire);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&wire.blocks[0]);
    seed = {kBatch, 1, 0, 3, 1};
    seed.insert(seed.end(), bytes, bytes + 3 * sizeof wire.blocks[0]);
  });
  add([](auto& seed) {
    dds::SessionRequest open;
    open.session = 2;
    open.station = "cam";
    append<meridian_wire_ClSession>(seed, kSession, open);
  });
  add([](auto& seed) {
    dds::Credit credit;
    credit.session = 1;
    credit.service_id = 7;
    credit.credits = 40;
    credit.verdict = dds::Verdict::kGood;
    append<meridian_wire_ClCredit>(seed, kCredit, credit);
    credit.next_sequence = 32;
    append<meridian_wire_ClCredit>(seed, kCredit, credit);
  });
  add([](auto& seed) {
    dds::CommandRequest start{.request = 1, .operator_id = 2, .verb = Verb::kStart};
    append<meridian_wire_Command>(seed, kCommand, start);
    append<meridian_wire_Reply>(seed, kReply, dds::Reply{});
    append<meridian_wire_Jog>(seed, kJog, dds::Jog{});
  });
  add([](auto& seed) {
    for (const int word : {0x6, 0x7, 0xf}) {
      for (std::uint16_t drive = 0; drive < 5; ++drive) {
        dds::DriveCommand command{
            .drive = drive, .controlword = static_cast<std::uint16_t>(word), .service_id = 1};
        append<meridian_wire_DriveCommand>(seed, kDriveCommand, command);
      }
    }
    dds::SetpointSample setpoint;
    setpoint.setpoint.cycle = 1;
    setpoint.setpoint.flags = kSetpointEnabled;
    append<meridian_wire_Setpoint>(seed, kSetpoint, setpoint);
  });
  add([](auto& seed) {
    dds::DriveFeedback feedback;
    feedback.joint_mask = 0x1f;
    feedback.sample = 1;
    append<meridian_wire_Feedback>(seed, kFeedback, feedback);
  });
  add([](auto& seed) {
    append<meridian_wire_Action>(seed, kAction, dds::Action{.kind = ActionKind::kNone});
    append<meridian_wire_ActionDone>(seed, kActionDone, dds::ActionDone{});
  });
  add([](auto& seed) {
    dds::MachineInfo machine;
    machine.name = "lai";
    machine.joint_count = 5;
    machine.is_serving = true;
    append<meridian_wire_Machine>(seed, kMachine, machine);
    append<meridian_wire_Status>(seed, kStatus, dds::Status{});
  });
  // Found: JSON that was cut off, a position that overflowed.
  add([](auto& seed) {
    dds::Status status;
    status.message = std::string(191, '\1');
    status.plan_time_s = 1e308;
    append<meridian_wire_Status>(seed, kStatus, status);
  });
  add([](auto& seed) {
    dds::SetpointSample setpoint;
    setpoint.setpoint = {.cycle = 1, .velocity = {1e308}, .flags = kSetpointEnabled};
    for (const int word : {0x6, 0x7, 0xf}) {
      append<meridian_wire_DriveCommand>(
          seed, kDriveCommand,
          dds::DriveCommand{.controlword = static_cast<std::uint16_t>(word), .service_id = 1});
    }
    append<meridian_wire_Setpoint>(seed, kSetpoint, setpoint);
    setpoint.setpoint.position = {-1e308};
    setpoint.setpoint.cycle = 2;
    append<meridian_wire_Setpoint>(seed, kSetpoint, setpoint);
    append<meridian_wire_Setpoint>(seed, kSetpoint, dds::SetpointSample{});
  });
  add([](auto& seed) { append<meridian_wire_Latency>(seed, kLatency, dds::Latency{}); });
  return seeds;
}

}  // namespace meridian::fuzz
