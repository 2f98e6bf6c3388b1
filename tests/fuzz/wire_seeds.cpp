// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "fuzz/fuzz_targets.hpp"
#include "fuzz/wire_samples.hpp"
#include "meridian/cycle/state_table.hpp"
#include "service/transport/convert/convert.hpp"
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
  if (type == kCommand) seed.insert(seed.end(), {0, 0});
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&wire);
  seed.insert(seed.end(), bytes, bytes + sizeof wire);
}

/// A command that is let through: it quotes the status that was published, and where `rest` is not
/// 0 the rest of the machine.
void append_command(std::vector<std::uint8_t>& seed, Verb verb, double argument,
                    std::uint8_t rest = 0) {
  const std::size_t at = seed.size();
  append<meridian_wire_Command>(seed, kCommand,
                                dds::CommandRequest{.request = 1,
                                                    .operator_id = 2,
                                                    .verb = verb,
                                                    .epoch_seen = 1,
                                                    .status_seen = 5,
                                                    .service_id_seen = 7,
                                                    .argument = argument});
  seed[at + 1] = seed[at + 2] = rest;
}

/// Blocks in inverse time, one of them an arc, as their session's first.
[[nodiscard]] dds::Batch batch_in_inverse_time() {
  dds::Batch batch = test::good_batch(1, 0, 3, true);
  for (std::uint32_t i = 1; i < 3; ++i) {
    batch.blocks[i].feed_meaning = FeedMeaning::kInverseTime;
    batch.blocks[i].feed = 2;
  }
  ClBlock& arc = batch.blocks[2];  // half a turn from x = 1 to 2
  arc.is_arc = true;
  arc.centre_mm = {1.5, 0, 0};
  arc.sweep_rad = 3.14159265358979323846;
  batch.crc = dds::batch_crc(batch);
  return batch;
}

/// A status that has everything that one may have, with `message`.
[[nodiscard]] dds::Status full_status(const std::string& message) {
  dds::Status status;
  status.state = State::kStepping;
  status.is_single_block = status.stops_at_optional = status.is_dry_run = true;
  status.message = message;
  return status;
}

const std::string kApproachWords =
    "approach to line 12: up 20 mm, joints straight b3 -12.5, b4 -100 mm, theta1 +360 deg, down 50 "
    "mm, 345.7 mm in 3.2 s, branch 1, theta1 at 388.6 deg";

/// What lets a hand on the joints of the machine in its dry run, and a word that a stop goes past.
void add_hand_and_stop(Seeds& seeds) {
  std::vector<std::uint8_t>& seed = seeds.emplace_back();
  append_command(seed, Verb::kDryRun, 1);
  append_command(seed, Verb::kEnable, 1);
  append_command(seed, Verb::kJog, 0);
  dds::Jog jog{.operator_id = 2, .status_seen = 5, .epoch_seen = 2, .dead_man_ns = 100'000'000};
  for (jog.sample = 1; jog.sample < 4; ++jog.sample) {
    jog.velocity = 40;
    jog.frame = jog.sample == 2 ? 1 : 0;
    append<meridian_wire_Jog>(seed, kJog, jog);
  }
  append_command(seed, Verb::kAbort, 0);
  append_command(seed, Verb::kDisable, 0);
  const std::size_t at = seed.size();
  append_command(seed, Verb::kEnable, 1);
  seed[at + 1] = 128;  // waits
  append_command(seed, Verb::kDisable, 0);
}

/// Another service, with the smaller service_id, which has served as long.
void add_other_service(Seeds& seeds) {
  dds::MachineInfo machine;
  machine.service_id = 2;
  machine.is_serving = true;
  machine.served_ns = 1'000'000'000'000;
  append<meridian_wire_Machine>(seeds.emplace_back(), kMachine, machine);
}

/// Everything that came to be said for a dry run, in single block and in inverse time.
void add_choices(Seeds& seeds) {
  const auto add = [&seeds](const auto& fill) { fill(seeds.emplace_back()); };
  add([](auto& seed) { append<meridian_wire_ClBatch>(seed, kRawBatch, batch_in_inverse_time()); });
  add([](auto& seed) {
    append_command(seed, Verb::kEnable, 1);
    append_command(seed, Verb::kDryRun, 1);
    append_command(seed, Verb::kEnable, 1);
    append_command(seed, Verb::kJog, 0);
    append_command(seed, Verb::kStart, 1);
    append_command(seed, Verb::kAbort, 0);
    append_command(seed, Verb::kDisable, 0);
    append_command(seed, Verb::kDryRun, 0);
    append_command(seed, Verb::kStart, 0);
  });
  add([](auto& seed) {
    for (const Verb verb : {Verb::kStart, Verb::kResume}) append_command(seed, verb, 0, 2);
    for (int verb = 0; verb < kVerbCount; ++verb) {
      for (const double argument : {0.0, 1.0, 0.5}) {
        append_command(seed, static_cast<Verb>(verb), argument);
      }
    }
  });
  add([](auto& seed) {
    dds::SetpointSample setpoint;
    for (const int flags : {kSetpointDry + 0, kSetpointDry | kSetpointDryEnabled | kSetpointMoving,
                            kSetpointDry | kSetpointEnabled, kSetpointEnabled + 0}) {
      ++setpoint.setpoint.cycle;
      setpoint.setpoint.flags = static_cast<std::uint16_t>(flags);
      append<meridian_wire_Setpoint>(seed, kSetpoint, setpoint);
    }
  });
  add([](auto& seed) {
    append<meridian_wire_Reply>(
        seed, kReply,
        dds::Reply{.is_accepted = true, .text = "dry run: start accepted; " + kApproachWords});
    append<meridian_wire_Reply>(seed, kReply, dds::Reply{.refusal = Refusal::kNotDryRun});
    append<meridian_wire_Status>(seed, kStatus, full_status(kApproachWords));
    append<meridian_wire_Status>(
        seed, kStatus,
        full_status("program blade.apt ran to its end (dry run): 4120 blocks in 309.2 s (approach "
                    "3.1, cut 280.0, single block 26.1)"));
  });
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
      for (std::uint8_t drive = 0; drive < 5; ++drive) {
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
    machine.is_serving = false;
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
  add_choices(seeds);
  add_hand_and_stop(seeds);
  add_other_service(seeds);
  return seeds;
}

}  // namespace meridian::fuzz
