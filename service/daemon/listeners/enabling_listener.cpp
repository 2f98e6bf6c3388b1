// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/enabling_listener.hpp"

#include <algorithm>
#include <cstring>

#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {

EnablingListener::EnablingListener(dds::Participant& participant, std::uint64_t service_id,
                                   Ports& ports)
    : service_id_(service_id),
      ports_(ports),
      reader_(participant, [this](auto& reader) { on_data(reader); }) {}

void EnablingListener::on_data(dds::Reader<dds::Enabling>& reader) noexcept {
  dds::SampleInfo info;
  while (reader.take(heartbeat_, info)) {
    const std::uint64_t seen = heartbeat_.service_id_seen;
    if (!info.is_valid || (seen != 0 && seen != service_id_)) continue;
    const auto beat = ports_.enabling.beat(info.source, heartbeat_.device, monotonic_ns());
    if (beat == EnablingWatch::Beat::kKnown) continue;
    EnablingChange change{.source = info.source, .beat = beat, .name = {}};
    const std::size_t length = std::min(heartbeat_.operator_name.size(), change.name.size() - 1);
    std::memcpy(change.name.data(), heartbeat_.operator_name.data(), length);
    (void)ports_.enabling_changes.try_push(change);
  }
}

}  // namespace meridian::interpolator
