// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/station_link.hpp"

#include <algorithm>
#include <thread>

#include "service/protocol/steady_ns.hpp"

namespace meridian::stream {

StationLink::StationLink(dds::Participant& participant, Station& station)
    : station_(station),
      requests_(participant),
      batches_(participant),
      credits_(participant),
      statuses_(participant),
      waitset_(participant) {
  waitset_.attach(credits_);
  waitset_.attach(statuses_);
}

bool StationLink::has_service() const noexcept {
  return requests_.matched_readers() > 0 && batches_.matched_readers() > 0 &&
         credits_.matched_writers() > 0;
}

bool StationLink::work(std::chrono::milliseconds timeout) {
  dds::Credit credit;
  bool has_credit = false;
  for (; credits_.take(credit); has_credit = true) station_.on_credit(credit, steady_ns());
  // Asked before the service knows this station, the answer could pass it by.
  if (station_.state() != StationState::kOpening || has_service()) {
    if (const auto request = station_.due_request(steady_ns())) {
      static_cast<void>(requests_.write(*request));
    }
  } else {
    constexpr std::chrono::milliseconds kLook{20};
    timeout = std::min(timeout, kLook);
  }
  constexpr int kBatchesAtOnce = 32;
  int sent = 0;
  while (sent < kBatchesAtOnce && station_.next_batch(steady_ns(), batch_)) {
    ++sent;
    if (batches_.write(batch_)) continue;
    station_.on_not_sent();
    break;
  }
  constexpr std::chrono::milliseconds kGather{2};
  if (station_.is_gathering()) timeout = std::min(timeout, kGather);
  if (sent < kBatchesAtOnce) waitset_.wait(timeout);
  return has_credit;
}

std::optional<dds::Status> StationLink::take_status() {
  dds::Status status;
  return followed_.take(statuses_, status) ? std::optional(status) : std::nullopt;
}

void StationLink::close() {
  if (!has_service()) return;
  static_cast<void>(requests_.write(station_.close_request()));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

}  // namespace meridian::stream
