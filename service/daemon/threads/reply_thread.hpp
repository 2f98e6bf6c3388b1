// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/daemon/ports/ports.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/writer.hpp"

namespace meridian::interpolator {

/// Writes replies: a thread of its own, so that no answer holds back a command or the drives.
class ReplyThread {
 public:
  ReplyThread(dds::Participant& participant, Ports& ports);

  /// Runs until Ports::is_stopping.
  void run() noexcept;
  [[nodiscard]] std::int32_t writer() const noexcept { return writer_.handle(); }

 private:
  void write(const QueuedReply& queued);

  Ports& ports_;
  dds::Writer<dds::Reply> writer_;
};

}  // namespace meridian::interpolator
