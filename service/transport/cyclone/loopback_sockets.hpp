// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

namespace meridian::dds {

/// The sockets of this process at its construction. Cyclone receives on all interfaces of the host,
/// also where its configuration names loopback alone: who is on a network could send to it.
/// Context: start-up. Proof: tests/unit/transport/loopback_sockets_test.cpp.
class SocketsBefore {
 public:
  SocketsBefore();
  /// Binds every UDP socket that was made since, and is open for all interfaces, to the loopback
  /// device. Returns how many; those that the kernel refuses are left as they are.
  int confine_newer_to_loopback() const;

 private:
  std::set<int> open_;
};

}  // namespace meridian::dds
