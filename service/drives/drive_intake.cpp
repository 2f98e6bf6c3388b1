// SPDX-License-Identifier: Apache-2.0
#include "service/drives/drive_intake.hpp"

#include <chrono>
#include <utility>

namespace meridian::drives {
namespace {

/// Samples that wait while one is taken on arrival.
constexpr int kWaiting = 64;
constexpr std::int64_t kBetweenChecks_ns = 20'000'000;

std::int64_t arrival_now_ns() noexcept {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace

template <class Message, std::size_t kPlaces>
DriveIntake::Tap<Message, kPlaces>::Tap(dds::Participant& participant,
                                        const std::atomic<std::uint64_t>& master)
    : master_(master),
      reader_(
          participant, [this](dds::Reader<Message>& reader) { on_data(reader); }, kWaiting) {}

/// A ring that is full loses the sample: it is full where the drives' thread stands still.
template <class Message, std::size_t kPlaces>
void DriveIntake::Tap<Message, kPlaces>::on_data(dds::Reader<Message>& reader) noexcept {
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

DriveIntake::DriveIntake(dds::Participant& participant, const Report& report)
    : participant_(participant),
      report_(report),
      commands_(participant, master_),
      setpoints_(participant, master_) {}

void DriveIntake::work(DriveGroup& group, std::int64_t now_ns) {
  Arrived<dds::DriveCommand> command;
  while (commands_.pop(command)) {
    const Drop drop = group.take(command.message, command.participant);
    if (drop == Drop::kNone) {
      if (master_source_ != command.source) checked_ns_ = 0;
      master_source_ = command.source;
    } else if (drop == Drop::kForeignCommand &&
               foreign_commands_.is_to_be_reported(command.source, now_ns)) {
      report_source(group, "drive commands", commands_.reader().handle(), command.source);
    }
    master_.store(group.pin().master().participant, std::memory_order_release);
  }
  Arrived<dds::SetpointSample> setpoint;
  while (setpoints_.pop(setpoint)) {
    (void)group.take(setpoint.message, setpoint.participant, setpoint.arrival_ns);
  }
  group.see_master(is_master_there(now_ns));
  master_.store(group.pin().master().participant, std::memory_order_release);
  report_foreign(group, now_ns);
}

bool DriveIntake::is_master_there(std::int64_t now_ns) {
  if (checked_ns_ == 0 || now_ns - checked_ns_ >= kBetweenChecks_ns) {
    checked_ns_ = now_ns;
    is_there_ = dds::participant_of(commands_.reader().handle(), master_source_) != 0;
  }
  return is_there_;
}

void DriveIntake::report_foreign(const DriveGroup& group, std::int64_t now_ns) {
  for (std::uint64_t source = 0; commands_.pop_foreign(source);) {
    if (!foreign_commands_.is_to_be_reported(source, now_ns)) continue;
    report_source(group, "drive commands", commands_.reader().handle(), source);
  }
  for (std::uint64_t source = 0; setpoints_.pop_foreign(source);) {
    if (!foreign_setpoints_.is_to_be_reported(source, now_ns)) continue;
    report_source(group, "setpoints", setpoints_.reader().handle(), source);
  }
}

void DriveIntake::report_source(const DriveGroup& group, const char* what, std::int32_t reader,
                                std::uint64_t source) {
  const std::string name = dds::describe_source(participant_, reader, source);
  const std::string master =
      dds::describe_source(participant_, commands_.reader().handle(), master_source_);
  report_(std::string(what) + " of " + name + " are dropped: the drives obey " + master +
          ", service " + std::to_string(group.pin().master().service_id));
}

DropCounts DriveIntake::dropped(const DriveGroup& group) const noexcept {
  DropCounts counts = group.dropped();
  counts.count(Drop::kForeignCommand, commands_.dropped());
  counts.count(Drop::kForeignSetpoint, setpoints_.dropped());
  return counts;
}

}  // namespace meridian::drives
