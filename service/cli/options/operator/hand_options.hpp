// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "service/cli/options/peer_options.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// What `meridian ctl jog` takes beside its joint and velocity.
struct JogOptions {
  double for_s = 0, distance = 0, dead_man_ms = 150;
};

/// Holds the joint of `words` (its name, then mm/s or deg/s) until time or distance is over or the
/// user interrupts; prints where it stands then. Returns the exit code.
[[nodiscard]] int run_jog(dds::Participant& participant, stream::OperatorLink& link,
                          const dds::MachineInfo& machine, const std::vector<std::string>& words,
                          const JogOptions& options, const PeerOptions& peer);

/// Returns the argument of the verb `home` for the joints of that name: their mask, 0 for all; or
/// prints what is wrong and returns -1.
[[nodiscard]] double home_argument(const dds::MachineInfo& machine,
                                   const std::vector<std::string>& names);

}  // namespace meridian::cli
