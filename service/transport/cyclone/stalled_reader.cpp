// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/stalled_reader.hpp"

#include "service/transport/cyclone/unacknowledged.h"
#include "service/transport/sources.hpp"

namespace meridian::dds {

std::optional<Unacknowledged> find_unacknowledged(const Participant& participant,
                                                  std::int32_t writer) {
  meridian_unacknowledged unacknowledged{};
  if (meridian_find_unacknowledged(writer, &unacknowledged) == 0) return std::nullopt;
  return Unacknowledged{unacknowledged.up_to, unacknowledged.sent,
                        describe_participant(participant, unacknowledged.participant)};
}

bool StallWatch::look(const std::optional<Unacknowledged>& unacknowledged, std::int64_t now_ns) {
  constexpr std::int64_t kPatience_ns = 2'000'000'000;
  const bool stands = unacknowledged && first_ && unacknowledged->up_to == first_->up_to &&
                      unacknowledged->who == first_->who;
  if (!stands) {
    first_ = unacknowledged;
    since_ns_ = now_ns;
  }
  return stands && now_ns - since_ns_ >= kPatience_ns;
}

std::string StalledReaders::look(std::int64_t now_ns) {
  std::string stalled;
  for (Watched& watched : writers_) {
    const auto unacknowledged = find_unacknowledged(participant_, watched.writer);
    if (!watched.watch.look(unacknowledged, now_ns)) continue;
    stalled += (stalled.empty() ? "" : "; ") + unacknowledged->who + " (" + watched.topic + ")";
  }
  return stalled;
}

}  // namespace meridian::dds
