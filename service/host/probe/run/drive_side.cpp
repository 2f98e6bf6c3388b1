// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/drive_side.hpp"

#include <algorithm>
#include <ctime>

#include "service/host/probe/figures.hpp"

namespace meridian::probe {
namespace {

[[nodiscard]] std::unique_ptr<dds::Writer<dds::DriveFeedback>> registered(
    dds::Participant& participant, dds::DriveFeedback& answer) {
  auto answers = std::make_unique<dds::Writer<dds::DriveFeedback>>(participant);
  answer.joint_mask = 1;
  answers->register_instance(answer);
  return answers;
}

}  // namespace

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

DriveSide::DriveSide(std::uint32_t domain, const std::string& partition, std::size_t max, Role role)
    : arrivals_(max),
      participant_({.domain = domain,
                    .machine = partition,
                    .transport = has_realtime_rights() ? dds::Transport::kLoopbackRealtime
                                                       : dds::Transport::kLoopback}),
      answers_(role == Role::kDrives ? registered(participant_, answer_) : nullptr),
      reader_(participant_, [this](dds::Reader<dds::SetpointSample>& reader) { note(reader); }) {}

void DriveSide::note(dds::Reader<dds::SetpointSample>& reader) {
  dds::SetpointSample sample;
  while (reader.take(sample)) {
    const std::int64_t now_ns = monotonic_ns();
    if (answers_ && is_answering_.load(std::memory_order_relaxed)) {
      ++answer_.sample;
      answer_.cycle_seen = sample.setpoint.cycle;
      (void)answers_->write(answer_);
    }
    const std::size_t index = count_.load(std::memory_order_relaxed);
    if (index < arrivals_.size()) {
      arrivals_[index] = {sample.setpoint.cycle, sample.setpoint.due_ns, now_ns};
      count_.store(index + 1, std::memory_order_release);
    }
  }
}

std::vector<DriveSide::Arrival> DriveSide::arrivals() const {
  const auto count = static_cast<std::ptrdiff_t>(count_.load(std::memory_order_acquire));
  std::vector<Arrival> arrivals(arrivals_.begin(), arrivals_.begin() + count);
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.cycle < b.cycle; });
  return arrivals;
}

}  // namespace meridian::probe
