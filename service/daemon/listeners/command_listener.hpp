// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/daemon/ports/ports.hpp"
#include "service/daemon/ports/status_clock.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::interpolator {

/// Takes operators' commands on Cyclone's receive thread, as they arrive. A stop (hold, abort,
/// disable) is staged for the cycle before anything else is looked at: it waits for no other
/// thread, no answer, no history, and is never taken for a repetition. Every command then goes on
/// to the commands thread, which answers it; where there is no room a stop is obeyed without an
/// answer, and anything else is dropped and counted. Proof:
/// tests/unit/daemon/command_listener_test.cpp, tests/attack.
class CommandListener {
 public:
  CommandListener(dds::Participant& participant, const StatusClock& status_clock, Ports& ports);

  /// Whose reader took Arrival::source.
  [[nodiscard]] std::int32_t reader() const noexcept { return reader_.handle(); }

 private:
  void on_data(dds::Reader<dds::CommandRequest>& reader) noexcept;
  void pass_tools(std::uint64_t key) noexcept;

  const StatusClock& status_clock_;
  Ports& ports_;
  dds::CommandRequest request_;
  ToolArrival tools_;
  dds::Reader<dds::CommandRequest> reader_;
};

}  // namespace meridian::interpolator
