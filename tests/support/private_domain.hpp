// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/host/process/claimed_domain.hpp"

namespace meridian::support {

/// A DDS domain that no other test of this host uses while it lives, from 100 to 220 (deploy/demo
/// has 60 to 99, probe and soak 221 to 230).
class PrivateDomain : public process::ClaimedDomain {
 public:
  PrivateDomain() : ClaimedDomain(100, 220) {}
};

}  // namespace meridian::support
