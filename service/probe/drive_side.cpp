// SPDX-License-Identifier: Apache-2.0
#include "service/probe/drive_side.hpp"

#include <ctime>

#include "service/probe/figures.hpp"

namespace meridian::probe {
std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

DriveSide::DriveSide(std::uint32_t domain, const std::string& partition, std::size_t most)
    : arrivals_(most),
      participant_({.domain = domain,
                    .machine = partition,
                    .transport = has_realtime_rights() ? dds::Transport::kLoopbackRealtime
                                                       : dds::Transport::kLoopback}),
      answers_(participant_),
      reader_(participant_, [this](dds::Reader<dds::SetpointSample>& reader) { note(reader); }) {
  answer_.joint_mask = 1;
  answers_.register_instance(answer_);
}

void DriveSide::note(dds::Reader<dds::SetpointSample>& reader) {
  dds::SetpointSample sample;
  while (reader.take(sample)) {
    const std::int64_t now_ns = monotonic_ns();
    if (is_answering_.load(std::memory_order_relaxed)) {
      ++answer_.sample;
      answer_.cycle_seen = sample.setpoint.cycle;
      (void)answers_.write(answer_);
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
  return {arrivals_.begin(), arrivals_.begin() + count};
}

}  // namespace meridian::probe
