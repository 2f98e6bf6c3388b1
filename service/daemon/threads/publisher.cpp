// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/publisher.hpp"

#include <utility>

#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {

Publisher::Publisher(dds::Participant& participant, std::uint64_t service_id, Ports& ports)
    : service_id_(service_id),
      ports_(ports),
      writer_(participant),
      spans_(ports.spans != nullptr ? &ports.spans->publisher : nullptr) {}

void Publisher::run() noexcept {
  constexpr std::int64_t kLookForStop_ns = 100'000'000;
  dds::SetpointSample sample;
  std::uint32_t drives_asked = 0;
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    const std::uint32_t seen = ports_.publisher_wake.look();
    while (ports_.setpoints.try_pop(sample.setpoint)) {
      const std::int64_t now_ns = monotonic_ns();
      sample.crc = dds::setpoint_crc(sample.setpoint, service_id_);
      ports_.sent_times.note(sample.setpoint.cycle, now_ns);
      if (!writer_.write(sample)) ports_.writes_failed.fetch_add(1, std::memory_order_relaxed);
      const std::int64_t written_ns = monotonic_ns();
      (void)ports_.publish_timings.try_push(
          {narrow_ns(now_ns - sample.setpoint.due_ns), narrow_ns(written_ns - now_ns)});
      spans_.write(trace::Doing::kWrite, now_ns, written_ns, sample.setpoint.cycle);
    }
    const std::uint32_t changes = ports_.drives_asked_changes.load(std::memory_order_acquire);
    if (std::exchange(drives_asked, changes) != changes) ports_.drives_wake.notify();
    ports_.publisher_wake.wait(seen, kLookForStop_ns);
  }
}

}  // namespace meridian::interpolator
