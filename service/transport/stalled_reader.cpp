// SPDX-License-Identifier: Apache-2.0
#include "service/transport/stalled_reader.hpp"

#include "service/transport/sources.hpp"
#include "service/transport/unacknowledged.h"

namespace meridian::dds {

std::optional<Unacknowledged> find_unacknowledged(const Participant& participant,
                                                  std::int32_t writer) {
  meridian_unacknowledged behind{};
  if (meridian_find_unacknowledged(writer, &behind) == 0) return std::nullopt;
  return Unacknowledged{behind.up_to, behind.sent,
                        describe_participant(participant, behind.participant)};
}

bool StallWatch::look(const std::optional<Unacknowledged>& behind, std::int64_t now_ns) {
  constexpr std::int64_t kPatience_ns = 2'000'000'000;
  const bool stands =
      behind && first_ && behind->up_to == first_->up_to && behind->who == first_->who;
  if (!stands) {
    first_ = behind;
    since_ns_ = now_ns;
  }
  return stands && now_ns - since_ns_ >= kPatience_ns;
}

std::string StalledReaders::look(std::int64_t now_ns) {
  std::string stalled;
  for (Watched& watched : writers_) {
    const auto behind = find_unacknowledged(participant_, watched.writer);
    if (!watched.watch.look(behind, now_ns)) continue;
    stalled += (stalled.empty() ? "" : "; ") + behind->who + " (" + watched.topic + ")";
  }
  return stalled;
}

}  // namespace meridian::dds
