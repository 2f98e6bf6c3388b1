// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/daemon/ports/ports.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::interpolator {

/// Takes the heartbeats of enabling devices on Cyclone's receive thread; what begins and ends goes
/// on to the commands thread, which reports it.
class EnablingListener {
 public:
  EnablingListener(dds::Participant& participant, std::uint64_t service_id, Ports& ports);

 private:
  void on_data(dds::Reader<dds::Enabling>& reader) noexcept;

  std::uint64_t service_id_;
  Ports& ports_;
  dds::Enabling heartbeat_;
  dds::Reader<dds::Enabling> reader_;
};

}  // namespace meridian::interpolator
