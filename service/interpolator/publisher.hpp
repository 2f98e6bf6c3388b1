// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/dds/messages.hpp"
#include "service/dds/setpoint_writer.hpp"
#include "service/interpolator/ports.hpp"

namespace meridian::interpolator {

/// Sends what the cycle hands over: woken by it on the same CPU, drains the setpoint ring into DDS.
/// Makes no heap call and no page fault while DDS is not secured.
class Publisher {
 public:
  Publisher(dds::Participant& participant, Ports& ports);

  /// Runs until Ports::is_stopping.
  void run() noexcept;

 private:
  Ports& ports_;
  dds::SetpointWriter writer_;
  trace::SpanWriter spans_;
};

}  // namespace meridian::interpolator
