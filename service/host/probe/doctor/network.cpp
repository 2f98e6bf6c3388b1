// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::probe {
namespace {

/// Cyclone is configured to ask for as much where the kernel grants it.
constexpr long long kWanted_bytes = 4'000'000;

[[nodiscard]] Finding socket_buffers(const HostFiles& host) {
  const auto max = host.number("proc/sys/net/core/rmem_max");
  if (!max) return {"socket buffers", Health::kNote, "not reported by this kernel", ""};
  const std::string found = "up to " + std::to_string(*max / 1024) + " kB for received data";
  if (*max >= kWanted_bytes) return {"socket buffers", Health::kFine, found, ""};
  return {"socket buffers", Health::kNote, found + "; a burst beyond that is sent again",
          "sysctl net.core.rmem_max=4194304"};
}

[[nodiscard]] Finding interface(const HostFiles& host, const std::string& uri) {
  if (!uri.empty()) return {"DDS configuration", Health::kFine, "CYCLONEDDS_URI=" + uri, ""};
  if (host.text("sys/class/net/lo/operstate").value_or("down") == "down") {
    return {"DDS configuration", Health::kBad, "loopback, which is down", "ip link set lo up"};
  }
  return {"DDS configuration", Health::kFine,
          "loopback: programs of this host alone (set CYCLONEDDS_URI for several hosts)", ""};
}

}  // namespace

Findings examine_network(const HostFiles& host, const std::string& cyclone_uri) {
  return {socket_buffers(host), interface(host, cyclone_uri)};
}

Findings examine_security(bool is_secured) {
  if (is_secured) {
    return {{"DDS security", Health::kFine, "secured: this identity, its role and no more", ""}};
  }
  return {{"DDS security", Health::kNote, "open: whoever reaches the DDS domain may command",
           "deploy/security/make_identities where the network is not only yours"}};
}

Findings examine_peers(const std::vector<dds::MachineInfo>& machines, const std::string& host_name,
                       const std::string& version) {
  if (machines.empty()) return {{"machines", Health::kFine, "no service answers here now", ""}};
  std::map<std::string, int> served;
  Findings out;
  for (const dds::MachineInfo& one : machines) {
    if (one.is_serving) ++served[one.name];
    Finding finding{"machine " + one.name, Health::kFine,
                    "service " + one.service_version + " on " + one.host + ", clock " + one.clock,
                    ""};
    if (one.service_version != version) {
      finding.health = Health::kNote;
      finding.remedy = "this tool is " + version + ": install one version everywhere";
    } else if (one.host != host_name && one.clock == "monotonic") {
      finding.health = Health::kNote;
      finding.found += "; due times mean nothing on this host, drives go by sequence alone";
      finding.remedy = "share a clock by PTP where drives on other hosts need due times";
    }
    out.push_back(std::move(finding));
  }
  for (const auto& [name, count] : served) {
    if (count < 2) continue;
    out.push_back({"machine " + name, Health::kBad,
                   std::to_string(count) + " services say that they serve it",
                   "stop all but one; a service refuses to start beside one that it sees, so look "
                   "for a network that was parted"});
  }
  return out;
}

}  // namespace meridian::probe
