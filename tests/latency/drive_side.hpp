// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "service/dds/messages.hpp"
#include "service/dds/participant.hpp"
#include "service/dds/reader.hpp"

namespace meridian::latency {

/// The end of the setpoint topic in a drive's process: notes when each cycle was seen, on Cyclone's
/// receive thread.
class DriveSide {
 public:
  /// Joins the partition of a machine; throws dds::DdsError.
  DriveSide(std::uint32_t domain, const std::string& partition);

  [[nodiscard]] bool is_connected() const { return reader_.matched_writers() > 0; }

  struct Arrival {
    std::uint64_t cycle = 0;
    std::int64_t due_ns = 0;
    std::int64_t seen_ns = 0;
  };
  /// Arrivals so far; call while nothing is being sent, or take the tail with a grain of salt.
  [[nodiscard]] std::vector<Arrival> arrivals() const;
  [[nodiscard]] std::size_t count() const { return count_.load(std::memory_order_acquire); }
  void forget() { count_.store(0, std::memory_order_release); }

 private:
  void note(dds::Reader<dds::SetpointSample>& reader);

  std::vector<Arrival> arrivals_;  // sized once; the receive thread fills it
  std::atomic<std::size_t> count_{0};
  dds::Participant participant_;
  dds::Reader<dds::SetpointSample> reader_;
};

[[nodiscard]] std::int64_t monotonic_ns();

/// Keeps the calling thread, and threads that it starts, off one CPU where there is another.
void stay_off_cpu(int cpu);

/// The last CPU that this process may use: the service's choice too.
[[nodiscard]] int last_cpu();

}  // namespace meridian::latency
