// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/publisher.hpp"

#include "service/interpolator/monotonic.hpp"

namespace meridian::interpolator {

Publisher::Publisher(dds::Participant& participant, Ports& ports)
    : ports_(ports), writer_(participant) {}

void Publisher::run() noexcept {
  constexpr std::int64_t kLookForStop_ns = 100'000'000;
  dds::SetpointSample sample;
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    const std::uint32_t seen = ports_.publisher_wake.look();
    while (ports_.setpoints.try_pop(sample.setpoint)) {
      sample.sent_minus_due_ns = narrow_ns(monotonic_ns() - sample.setpoint.due_ns);
      if (!writer_.write(sample)) ports_.writes_failed.fetch_add(1, std::memory_order_relaxed);
      (void)ports_.sent_minus_due.try_push(sample.sent_minus_due_ns);
    }
    ports_.publisher_wake.wait(seen, kLookForStop_ns);
  }
}

}  // namespace meridian::interpolator
