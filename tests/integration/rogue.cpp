// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

/// rogue DOMAIN MACHINE HOW: somebody in a machine's domain who tries every topic for 2.5 s. In HOW
/// `w` makes writers, `s` sends on them what would do harm, `r` makes readers. At the end it prints
/// what got through, a line each: `writes TOPIC` where somebody listens to it, `reads TOPIC` where
/// it was sent something.
namespace {

using namespace meridian;

struct Attempt {
  std::function<void()> work;
  std::function<bool()> got_through;
  std::string what;
};

/// Where the identity's own permissions refuse the writer already, nothing is there to work with.
template <class Message>
void try_to_write(dds::Participant& participant, const char* topic, const Message& harm, bool sends,
                  std::vector<Attempt>& attempts) {
  try {
    auto writer = std::make_shared<dds::Writer<Message>>(participant);
    attempts.push_back({[writer, harm, sends] {
                          if (sends) static_cast<void>(writer->write(harm));
                        },
                        [writer] { return writer->matched_readers() > 0; },
                        std::string("writes ") + topic});
  } catch (const dds::DdsError& error) {
    std::printf("%s\n", error.what());
  }
}

template <class Message>
void try_to_read(dds::Participant& participant, const char* topic, std::vector<Attempt>& attempts) {
  try {
    auto reader = std::make_shared<dds::Reader<Message>>(participant);
    auto count = std::make_shared<int>(0);
    attempts.push_back({[reader, count] {
                          auto message = std::make_unique<Message>();
                          while (reader->take(*message)) ++*count;
                        },
                        [count] { return *count > 0; }, std::string("reads ") + topic});
  } catch (const dds::DdsError& error) {
    std::printf("%s\n", error.what());
  }
}

void try_all_writers(dds::Participant& participant, bool sends, std::vector<Attempt>& all) {
  dds::CommandRequest disable;
  disable.request = disable.operator_id = 666;
  disable.verb = Verb::kDisable;
  dds::SessionRequest session;
  session.session = 666;
  dds::SetpointSample setpoint;
  setpoint.setpoint.cycle = 1ULL << 40U;
  setpoint.setpoint.position.fill(1);
  dds::DriveCommand off;  // controlword 0: disable voltage
  dds::DriveFeedback feedback;
  feedback.joint_mask = 0x1f;
  feedback.sample = 1ULL << 40U;
  feedback.is_emergency_stop = true;
  try_to_write(participant, "command", disable, sends, all);
  try_to_write(participant, "cl_session", session, sends, all);
  try_to_write(participant, "cl_batch", dds::Batch{}, sends, all);
  try_to_write(participant, "setpoint", setpoint, sends, all);
  try_to_write(participant, "drive_command", off, sends, all);
  try_to_write(participant, "feedback", feedback, sends, all);
  dds::Jog jog;  // the only word that moves a machine at once
  jog.operator_id = 666;
  jog.velocity = 1;
  jog.distance = 1;
  jog.dead_man_ns = 1'000'000'000;
  dds::Status calm;  // of a service that outranks every other
  calm.service_id = 1;
  dds::MachineInfo claim;
  claim.service_id = 1;
  claim.served_ns = 1LL << 60U;
  claim.name = "lai";
  claim.is_serving = true;
  dds::Credit credit;
  credit.session = 666;
  credit.credits = 1000;
  try_to_write(participant, "jog", jog, sends, all);
  try_to_write(participant, "reply", dds::Reply{}, sends, all);
  try_to_write(participant, "cl_credit", credit, sends, all);
  try_to_write(participant, "status", calm, sends, all);
  try_to_write(participant, "machine", claim, sends, all);
  try_to_write(participant, "latency", dds::Latency{}, sends, all);
  try_to_write(participant, "action", dds::Action{}, sends, all);
  try_to_write(participant, "action_done", dds::ActionDone{}, sends, all);
}

void try_all_readers(dds::Participant& participant, std::vector<Attempt>& all) {
  try_to_read<dds::Status>(participant, "status", all);
  try_to_read<dds::MachineInfo>(participant, "machine", all);
  try_to_read<dds::Latency>(participant, "latency", all);
  try_to_read<dds::SetpointSample>(participant, "setpoint", all);
  try_to_read<dds::DriveCommand>(participant, "drive_command", all);
  try_to_read<dds::DriveFeedback>(participant, "feedback", all);
  try_to_read<dds::CommandRequest>(participant, "command", all);
  try_to_read<dds::Reply>(participant, "reply", all);
  try_to_read<dds::Jog>(participant, "jog", all);
  try_to_read<dds::SessionRequest>(participant, "cl_session", all);
  try_to_read<dds::Batch>(participant, "cl_batch", all);
  try_to_read<dds::Credit>(participant, "cl_credit", all);
  try_to_read<dds::Action>(participant, "action", all);
  try_to_read<dds::ActionDone>(participant, "action_done", all);
}

int attack(std::uint32_t domain, const std::string& machine, const std::string& how) {
  dds::Participant participant({.domain = domain, .machine = machine});
  const auto has = [&how](char letter) { return how.find(letter) != std::string::npos; };
  std::vector<Attempt> attempts;
  if (has('w')) try_all_writers(participant, has('s'), attempts);
  if (has('r')) try_all_readers(participant, attempts);
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(4000);
  while (std::chrono::steady_clock::now() < end) {
    for (const Attempt& attempt : attempts) attempt.work();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (const Attempt& attempt : attempts) {
    if (attempt.got_through()) std::printf("%s\n", attempt.what.c_str());
  }
  std::printf("done\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  try {
    return attack(static_cast<std::uint32_t>(std::atoi(argv[1])), argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
