// SPDX-License-Identifier: Apache-2.0
#include "service/dds/stalled_reader.hpp"

#include "service/dds/sources.hpp"
#include "service/dds/unacknowledged.h"

namespace meridian::dds {

std::optional<Unacknowledged> find_unacknowledged(const Participant& participant,
                                                  std::int32_t writer) {
  meridian_unacknowledged behind{};
  if (meridian_find_unacknowledged(writer, &behind) == 0) return std::nullopt;
  return Unacknowledged{behind.up_to, behind.sent,
                        describe_participant(participant, behind.participant)};
}

std::string StalledReaders::look(std::int64_t now_ns) {
  constexpr std::int64_t kPatience_ns = 2'000'000'000;
  std::string stalled;
  for (Watched& watched : writers_) {
    const auto behind = find_unacknowledged(participant_, watched.writer);
    if (!behind) {
      watched.since_ns = 0;
    } else if (watched.since_ns == 0 || behind->up_to != watched.up_to) {
      watched.since_ns = now_ns;
      watched.up_to = behind->up_to;
    }
    const bool is_stalled = behind && now_ns - watched.since_ns >= kPatience_ns;
    watched.who = is_stalled ? behind->who : "";
    if (!is_stalled) continue;
    stalled += (stalled.empty() ? "" : "; ") + watched.who + " (" + watched.topic + ")";
  }
  return stalled;
}

}  // namespace meridian::dds
