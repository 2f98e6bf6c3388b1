// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::probe {

/// The end of the setpoint topic in a drive's process: notes when each cycle was seen, on Cyclone's
/// receive thread, and where wanted answers at once with a feedback about it.
class DriveSide {
 public:
  enum class Role : std::uint8_t {
    kDrives,   ///< there are no others
    kListener  ///< others are the drives: it never answers
  };
  /// Joins the partition of a machine with room for `max` arrivals; throws dds::DdsError.
  DriveSide(std::uint32_t domain, const std::string& partition, std::size_t max = 200'000,
            Role role = Role::kDrives);

  [[nodiscard]] bool is_connected() const { return reader_.matched_writers() > 0; }
  /// From here on every setpoint is answered, or none is. A listener answers none.
  void answer(bool is_wanted) { is_answering_ = is_wanted; }

  struct Arrival {
    std::uint64_t cycle = 0;
    std::int64_t due_ns = 0;
    std::int64_t seen_ns = 0;
  };
  /// Arrivals so far, in order of their cycles; call while nothing is being sent, or take the tail
  /// with a grain of salt.
  [[nodiscard]] std::vector<Arrival> arrivals() const;
  [[nodiscard]] std::size_t count() const { return count_.load(std::memory_order_acquire); }
  void forget() { count_.store(0, std::memory_order_release); }
  [[nodiscard]] dds::Participant& participant() { return participant_; }

 private:
  void note(dds::Reader<dds::SetpointSample>& reader);

  std::vector<Arrival> arrivals_;  // sized once; the receive thread fills it
  std::atomic<std::size_t> count_{0};
  std::atomic<bool> is_answering_{false};
  dds::DriveFeedback answer_;
  dds::Participant participant_;
  std::unique_ptr<dds::Writer<dds::DriveFeedback>> answers_;  ///< a listener has none
  dds::Reader<dds::SetpointSample> reader_;
};

/// Now on the machine's clock, ns.
[[nodiscard]] std::int64_t monotonic_ns();

}  // namespace meridian::probe
