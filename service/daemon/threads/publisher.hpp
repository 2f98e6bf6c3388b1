// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/daemon/ports/ports.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/setpoint_writer.hpp"

namespace meridian::interpolator {

/// Sends what the cycle hands over: woken by it on the same CPU, drains the setpoint ring into DDS.
/// Makes no heap call and no page fault while DDS is not secured.
class Publisher {
 public:
  Publisher(dds::Participant& participant, std::uint64_t service_id, Ports& ports);

  /// Runs until Ports::is_stopping.
  void run() noexcept;

 private:
  std::uint64_t service_id_;
  Ports& ports_;
  dds::SetpointWriter writer_;
  trace::SpanWriter spans_;
};

}  // namespace meridian::interpolator
