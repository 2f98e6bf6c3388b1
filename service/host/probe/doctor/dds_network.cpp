// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/doctor/dds_network.hpp"

#include <net/if.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>

#include "service/transport/cyclone/network_config.hpp"

namespace meridian::probe {
namespace {

/// The XML that CYCLONEDDS_URI means: itself, or files, one after the other. Nothing where one of
/// them cannot be read; `missing` is it then.
[[nodiscard]] std::optional<std::string> read_uri(const HostFiles& host, const std::string& uri,
                                                  std::string& missing) {
  if (uri.find('<') != std::string::npos) return uri;
  std::string all;
  std::istringstream parts(uri);
  for (std::string part; std::getline(parts, part, ',');) {
    constexpr std::string_view kScheme = "file://";
    if (part.starts_with(kScheme)) part.erase(0, kScheme.size());
    const auto file = std::filesystem::absolute(part).relative_path().string();
    const auto text = host.text(file);
    if (!text) {
      missing = part;
      return std::nullopt;
    }
    all += *text;
  }
  return all;
}

[[nodiscard]] std::optional<unsigned long> flags_of(const HostFiles& host,
                                                    const std::string& interface) {
  const auto text = host.text("sys/class/net/" + interface + "/flags");
  if (!text) return std::nullopt;
  return std::strtoul(text->c_str(), nullptr, 16);
}

[[nodiscard]] Finding check_interface(const HostFiles& host, const std::string& said,
                                      const std::string& name) {
  const std::string found = said == name ? name : said + " (" + name + ")";
  const auto flags = flags_of(host, name);
  if (name.empty() || !flags) {
    return {"DDS interface", Health::kBad, said + ", which this host does not have",
            "name one of this host in CYCLONEDDS_URI: ip -brief address"};
  }
  if ((*flags & IFF_UP) == 0) {
    return {"DDS interface", Health::kBad, found + ", which is down",
            "ip link set " + name + " up"};
  }
  if (host.text("sys/class/net/" + name + "/operstate") == std::optional<std::string>("down")) {
    return {"DDS interface", Health::kBad, found + ", which has no link",
            "look for its cable, and what is at the other end"};
  }
  return {"DDS interface", Health::kFine, found, ""};
}

[[nodiscard]] Finding check_multicast(const HostFiles& host, const dds::NetworkConfig& configured,
                                      const std::string& interface, const NetworkView& network) {
  if (!configured.has_multicast) {
    if (!configured.peers.empty()) {
      return {"DDS multicast", Health::kFine, "not used: peers are named", ""};
    }
    return {"DDS multicast", Health::kBad, "not used, and no peer is named: nobody is found",
            "name the hosts under <Discovery><Peers>"};
  }
  if (interface.empty()) {
    if (network.carries_multicast("")) {
      return {"DDS multicast", Health::kFine, "works where this host sends it by default", ""};
    }
    return {"DDS multicast", Health::kNote,
            "a datagram to a group does not come back where this host sends it by default",
            "name the interface of the machine's network in CYCLONEDDS_URI, and ask again"};
  }
  const auto flags = flags_of(host, interface);
  if (!flags || (*flags & IFF_MULTICAST) == 0) {
    return {"DDS multicast", Health::kBad, interface + " carries none",
            "AllowMulticast false and <Discovery><Peers> with the hosts, or: ip link set " +
                interface + " multicast on"};
  }
  if (!network.carries_multicast(interface)) {
    return {"DDS multicast", Health::kBad,
            "a datagram to a group does not come back on " + interface,
            "let the firewall pass UDP to 239.255.0.0/16, or AllowMulticast false and "
            "<Discovery><Peers> with the hosts"};
  }
  return {"DDS multicast", Health::kFine,
          "works on " + interface + " of this host; switches between hosts may still drop it", ""};
}

[[nodiscard]] Finding check_peer(const std::string& peer, Reach reach) {
  const std::string what = "DDS peer " + peer;
  switch (reach) {
    case Reach::kAnswers:
      return {what, Health::kFine, "answers", ""};
    case Reach::kSilent:
      return {what, Health::kNote, "is silent",
              "switch it on; or its firewall drops what it gets: open UDP 7400 to 7400 + 250 * "
              "domain + 100"};
    case Reach::kNoRoute:
      return {what, Health::kBad, "no way there from this host",
              "give the interface of DDS an address in its network: ip route get " + peer};
    case Reach::kNoAddress:
      return {what, Health::kBad, "a name that nobody knows",
              "write its address, or put it into /etc/hosts"};
  }
  return {what, Health::kFine, "", ""};
}

}  // namespace

Findings examine_dds_network(const HostFiles& host, const std::string& cyclone_uri,
                             const NetworkView& network) {
  if (cyclone_uri.empty()) {
    return {check_interface(host, "lo", "lo"),
            check_multicast(host, {{"lo"}, {"127.0.0.1"}, false}, "lo", network)};
  }
  std::string missing;
  const auto xml = read_uri(host, cyclone_uri, missing);
  if (!xml) {
    return {{"DDS interface", Health::kBad, missing + " cannot be read",
             "name a file that this user may read in CYCLONEDDS_URI"}};
  }
  const dds::NetworkConfig configured = dds::read_network_config(*xml);
  Findings out;
  if (configured.interfaces.empty()) {
    out.push_back({"DDS interface", Health::kNote, "none is named: Cyclone takes the one it likes",
                   "name the interface of the machine's network in CYCLONEDDS_URI"});
    out.push_back(check_multicast(host, configured, "", network));
  }
  for (const std::string& said : configured.interfaces) {
    const bool is_name = flags_of(host, said).has_value();
    const std::string name = is_name ? said : network.interface_of(said);
    out.push_back(check_interface(host, said, name));
    if (out.back().health != Health::kFine) continue;
    out.push_back(check_multicast(host, configured, name, network));
  }
  for (const std::string& peer : configured.peers) {
    out.push_back(check_peer(peer, network.reach(peer)));
  }
  return out;
}

}  // namespace meridian::probe
