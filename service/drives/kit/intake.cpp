// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/intake.hpp"

#include <chrono>

namespace meridian::drive {
namespace {

/// Samples that wait while one is taken on arrival.
constexpr int kWaiting = 64;
constexpr std::int64_t kBetweenChecks_ns = 20'000'000;

std::int64_t arrival_now_ns() noexcept {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace

template <class Message, std::size_t kCapacity>
Intake::Tap<Message, kCapacity>::Tap(dds::Participant& participant,
                                     const std::atomic<std::uint64_t>& master)
    : master_(master),
      reader_(
          participant, [this](dds::Reader<Message>& reader) { on_data(reader); }, kWaiting) {}

/// A ring that is full loses the sample: it is full where the drives' thread stands still.
template <class Message, std::size_t kCapacity>
void Intake::Tap<Message, kCapacity>::on_data(dds::Reader<Message>& reader) noexcept {
  Arrived<Message> arrived;
  dds::SampleInfo info;
  while (reader.take(arrived.message, info)) {
    if (!info.is_valid) continue;
    arrived.source = info.source;
    arrived.participant = senders_.participant_of(reader.handle(), info.source);
    arrived.arrival_ns = arrival_now_ns();
    const std::uint64_t master = master_.load(std::memory_order_acquire);
    if (master == 0 || master == arrived.participant) {
      (void)ring_.try_push(arrived);
      continue;
    }
    dropped_.fetch_add(1, std::memory_order_relaxed);
    (void)foreign_.try_push(info.source);
  }
}

Intake::Intake(dds::Participant& participant, const Report& report)
    : participant_(participant),
      report_(report),
      commands_(participant, master_),
      setpoints_(participant, master_),
      machines_(participant) {}

void Intake::receive(Receiver& receiver) noexcept {
  for (Bridge bridge; bridges_.try_pop(bridge);) receiver.take(bridge);
  Arrived<dds::DriveCommand> command;
  while (commands_.pop(command)) {
    const Drop drop = receiver.take(command.message, command.participant);
    if (drop == Drop::kNone) master_source_.store(command.source, std::memory_order_release);
    if (drop == Drop::kForeignCommand) (void)refused_.try_push(command.source);
    note_master(receiver);
  }
  Arrived<dds::SetpointSample> setpoint;
  while (setpoints_.pop(setpoint)) {
    (void)receiver.take(setpoint.message, setpoint.participant, setpoint.arrival_ns);
  }
  const std::uint64_t source = master_source_.load(std::memory_order_relaxed);
  receiver.see_master(source != 0 && gone_source_.load(std::memory_order_acquire) != source);
  note_master(receiver);
}

void Intake::note_master(const Receiver& receiver) noexcept {
  service_id_.store(receiver.pin().master().service_id, std::memory_order_relaxed);
  master_.store(receiver.pin().master().participant, std::memory_order_release);
}

void Intake::look(std::int64_t now_ns) {
  look_for_bridges();
  look_for_master(now_ns);
  report_foreign(now_ns);
}

void Intake::look_for_bridges() {
  dds::MachineInfo machine;
  dds::SampleInfo info;
  while (machines_.take(machine, info)) {
    if (!info.is_valid) continue;
    const std::uint64_t sender = senders_.participant_of(machines_.handle(), info.source);
    if (const auto bridge = bridge_of(machine, sender)) (void)bridges_.try_push(*bridge);
  }
}

void Intake::look_for_master(std::int64_t now_ns) {
  const std::uint64_t source = master_source_.load(std::memory_order_acquire);
  if (source == 0) return;
  if (source == checked_source_ && now_ns - checked_ns_ < kBetweenChecks_ns) return;
  checked_source_ = source;
  checked_ns_ = now_ns;
  const bool is_there = dds::participant_of(commands_.reader().handle(), source) != 0;
  gone_source_.store(is_there ? 0 : source, std::memory_order_release);
}

void Intake::report_foreign(std::int64_t now_ns) {
  for (std::uint64_t source = 0; refused_.try_pop(source);) report_command(source, now_ns);
  for (std::uint64_t source = 0; commands_.pop_foreign(source);) report_command(source, now_ns);
  for (std::uint64_t source = 0; setpoints_.pop_foreign(source);) {
    if (!foreign_setpoints_.is_to_be_reported(source, now_ns)) continue;
    report_source("setpoints", setpoints_.reader().handle(), source);
  }
}

void Intake::report_command(std::uint64_t source, std::int64_t now_ns) {
  if (!foreign_commands_.is_to_be_reported(source, now_ns)) return;
  report_source("drive commands", commands_.reader().handle(), source);
}

void Intake::report_source(const char* what, std::int32_t reader, std::uint64_t source) {
  const std::string name = dds::describe_source(participant_, reader, source);
  const std::string master =
      dds::describe_source(participant_, commands_.reader().handle(), master_source_.load());
  report_(std::string(what) + " of " + name + " are dropped: the drives obey " + master +
          ", service " + std::to_string(service_id_.load()));
}

void Intake::add_dropped(DropCounts& counts) const noexcept {
  counts.count(Drop::kForeignCommand, commands_.dropped());
  counts.count(Drop::kForeignSetpoint, setpoints_.dropped());
}

}  // namespace meridian::drive
