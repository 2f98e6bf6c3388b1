// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "service/host/probe/doctor/finding.hpp"
#include "service/host/probe/doctor/host_files.hpp"

namespace meridian::probe {

/// What came of an attempt to reach another host.
enum class Reach : std::uint8_t {
  kAnswers,
  kSilent,    ///< nothing came back: it is off, or a firewall drops what we send
  kNoRoute,   ///< this host has no way there
  kNoAddress  ///< a name that nobody knows
};

/// What the network says when it is asked; tests answer for it.
struct NetworkView {
  /// Name of the interface that has this address; empty: none.
  std::function<std::string(const std::string& address)> interface_of;
  /// Whether a datagram to a group comes back on this interface; empty: the kernel's choice.
  std::function<bool(const std::string& interface)> carries_multicast;
  std::function<Reach(const std::string& peer)> reach;
};

/// This host's: sends one datagram to a group, and asks a peer for a TCP connection, which any host
/// that is there refuses. Half a second each at most, and a name server's time.
[[nodiscard]] NetworkView real_network();

/// The interface of DDS, whether multicast works there, and whether the peers that are configured
/// can be reached. `cyclone_uri` is CYCLONEDDS_URI; empty: the configuration that is built in.
/// Proof: tests/unit/probe/dds_network_test.cpp.
[[nodiscard]] Findings examine_dds_network(const HostFiles& host, const std::string& cyclone_uri,
                                           const NetworkView& network);

}  // namespace meridian::probe
