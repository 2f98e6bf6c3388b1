// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/credit_writer.hpp"

#include <utility>

#include "service/dds/stalled_reader.hpp"

namespace meridian::interpolator {

CreditWriter::CreditWriter(dds::Participant& participant)
    : CreditWriter(participant, [&participant](std::int32_t writer) -> std::uint64_t {
        const auto behind = dds::find_unacknowledged(participant, writer);
        return behind ? behind->sent - behind->up_to : 0;
      }) {}

CreditWriter::CreditWriter(dds::Participant& participant, Unacknowledged unacknowledged)
    : participant_(participant),
      unacknowledged_(std::move(unacknowledged)),
      writer_(std::make_unique<dds::Writer<dds::Credit>>(participant)),
      handle_(writer_->handle()) {}

void CreditWriter::end(const dds::Credit& credit) {
  writer_->dispose(credit);
  if (++ends_ < kEndsBetweenLooks) return;
  ends_ = 0;
  if (unacknowledged_(handle()) > kMaxUnacknowledged) replace();
}

void CreditWriter::replace() {
  auto next = std::make_unique<dds::Writer<dds::Credit>>(participant_);
  handle_.store(next->handle(), std::memory_order_relaxed);
  closing_ = std::jthread([old = std::exchange(writer_, std::move(next))]() mutable {
    old.reset();
  });
}

}  // namespace meridian::interpolator
