// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "service/protocol/station/station.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/waitset.hpp"
#include "service/transport/writer.hpp"

namespace meridian::stream {

/// Puts a Station on the wire: sends what it has due, brings it what comes. One thread.
class StationLink {
 public:
  /// Throws DdsError.
  StationLink(dds::Participant& participant, Station& station);

  /// Sends and receives what there is; waits at most `timeout` where there is nothing. Whether a
  /// credit came: a word from the service.
  bool work(std::chrono::milliseconds timeout);
  /// Ends a work() that waits, or the next one; from any thread.
  void wake() noexcept { waitset_.wake(); }
  /// Gives the machine back and lets the word get out.
  void close();

  /// A status that came since the last call.
  [[nodiscard]] std::optional<dds::Status> take_status();
  /// Whether a service listens to this station.
  [[nodiscard]] bool has_service() const noexcept;

 private:
  Station& station_;
  dds::Writer<dds::SessionRequest> requests_;
  dds::Writer<dds::Batch> batches_;
  dds::Reader<dds::Credit> credits_;
  dds::Reader<dds::Status> statuses_;
  dds::Followed<dds::Status> followed_;
  dds::Waitset waitset_;
  dds::Batch batch_;
};

}  // namespace meridian::stream
