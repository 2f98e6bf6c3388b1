// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// What a Cyclone configuration says of the network. Context: start-up.
/// Proof: tests/unit/transport/network_config_test.cpp.
namespace meridian::dds {

struct NetworkConfig {
  std::vector<std::string> interfaces;  ///< names or addresses; none: Cyclone chooses
  std::vector<std::string> peers;
  bool has_multicast = true;
  bool is_chosen_by_cyclone = false;  ///< an interface element that names none
};

/// Reads XML, also fragments of it, one after the other. What is no XML says nothing.
[[nodiscard]] NetworkConfig read_network_config(const std::string& xml);

/// Whether what is sent with this configuration can leave the host, or come from another one: all
/// but configurations that name interfaces, and only loopback ones.
[[nodiscard]] bool leaves_host(const NetworkConfig& config);

/// The same for the value of CYCLONEDDS_URI: XML, or files separated by commas. One that cannot be
/// read counts as leaving the host.
[[nodiscard]] bool leaves_host(const std::string& cyclone_uri);

}  // namespace meridian::dds
