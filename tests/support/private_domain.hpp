// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/host/process/claimed_domain.hpp"

namespace meridian::support {

/// A DDS domain that no other test of this host uses while it lives, from 100 to 169 (deploy/demo
/// has 60 to 99, tests of the panel 170 to 199, those in HAL 200 to 219, probe and soak 221 to 230).
class PrivateDomain : public process::ClaimedDomain {
 public:
  PrivateDomain() : ClaimedDomain(100, 169) {}
};

}  // namespace meridian::support
