// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/reply_thread.hpp"

namespace meridian::interpolator {

ReplyThread::ReplyThread(dds::Participant& participant, Ports& ports)
    : ports_(ports), writer_(participant) {}

void ReplyThread::run() noexcept {
  constexpr std::int64_t kLookForStop_ns = 50'000'000;
  QueuedReply queued;
  bool is_last = false;
  while (!is_last) {
    is_last = ports_.is_stopping.load(std::memory_order_relaxed);
    const std::uint32_t seen = ports_.reply_wake.look();
    while (ports_.replies.try_pop(queued)) write(queued);
    if (!is_last) ports_.reply_wake.wait(seen, kLookForStop_ns);
  }
}

void ReplyThread::write(const QueuedReply& queued) {
  const bool is_written = writer_.write({.request = queued.request,
                                         .operator_id = queued.operator_id,
                                         .service_id = queued.service_id,
                                         .requester = queued.requester,
                                         .verb = queued.verb,
                                         .is_accepted = queued.is_accepted,
                                         .refusal = queued.refusal,
                                         .state = queued.state,
                                         .epoch = queued.epoch,
                                         .text = queued.text.data()});
  if (!is_written) ports_.replies_dropped.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace meridian::interpolator
