// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::cli {

/// What is wrong with this host for a cycle on processor `cpu`, with `cyclone_uri` as
/// CYCLONEDDS_URI. `rights`: what this process was allowed; null: that of somebody else counts, so
/// nothing is said of rights, nor of what depends on them.
[[nodiscard]] probe::Findings examine_host(int cpu, const std::string& cyclone_uri,
                                           const probe::Rights* rights);
/// CYCLONEDDS_URI; empty where it is not set.
[[nodiscard]] std::string cyclone_uri();

}  // namespace meridian::cli
