// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/machine_finder.hpp"

#include <algorithm>

#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/waitset.hpp"

namespace meridian::stream {
namespace {

using Clock = std::chrono::steady_clock;

/// One service per machine: the newest word of the one that serves it. Of two that serve, the one
/// that has served longer, as between themselves, where both have said so within half a second, as
/// they do once they have heard of each other. Until then the older words of one may hide that, and
/// it is the one that said the more when it spoke last.
void take(const dds::MachineInfo& info, std::vector<dds::MachineInfo>& found) {
  const auto same = std::find_if(found.begin(), found.end(), [&](const dds::MachineInfo& other) {
    return other.name == info.name;
  });
  if (same == found.end()) {
    found.push_back(info);
  } else if (same->service_id == info.service_id || info.served_ns > same->served_ns) {
    *same = info;
  }
}

}  // namespace

std::vector<dds::MachineInfo> find_machines(std::uint32_t domain, const std::string& machine,
                                            std::chrono::milliseconds timeout) {
  constexpr std::chrono::milliseconds kMoment{150};
  dds::Participant participant({.domain = domain, .machine = machine.empty() ? "*" : machine});
  dds::Reader<dds::MachineInfo> reader(participant);
  dds::Waitset waitset(participant);
  waitset.attach(reader);

  std::vector<dds::MachineInfo> found;
  auto end = Clock::now() + timeout;
  for (auto now = Clock::now(); now < end; now = Clock::now()) {
    waitset.wait(end - now);
    dds::MachineInfo info;
    while (reader.take(info)) {
      if (!info.is_serving) continue;  // it waits for another one to leave the machine
      if (found.empty()) end = Clock::now() + (machine.empty() ? kMoment : kMoment / 150);
      take(info, found);
    }
  }
  std::sort(found.begin(), found.end(),
            [](const dds::MachineInfo& a, const dds::MachineInfo& b) { return a.name < b.name; });
  return found;
}

}  // namespace meridian::stream
