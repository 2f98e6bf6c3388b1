// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/dds/messages.hpp"
#include "service/dds/participant.hpp"
#include "service/dds/reader.hpp"
#include "service/interpolator/ports.hpp"

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
