// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "meridian/rt/histogram.hpp"

namespace meridian::probe {

/// What the service did while a program ran.
struct WorkResult {
  std::vector<std::int64_t> computation_ns;  ///< a cycle: evaluate, inverse kinematics, guard
  Histogram wake;                            ///< waking the publisher, on the cycle thread
  std::uint64_t lost_periods = 0;
  std::string broken_off;  ///< why the program was not cut for that long; empty: it was
};

/// Lets service, simulated drives and station cut a program that moves every joint, for `seconds`
/// at most. Everything runs as processes in `folder`; `machine` is the machine file. A machine that
/// a host like this one takes to Fault is a result. Throws std::runtime_error with what the service
/// said where it does not end as it should.
[[nodiscard]] WorkResult run_work(std::uint32_t domain, const std::filesystem::path& folder,
                                  const std::string& machine, const std::string& name,
                                  std::int64_t period_ns, double seconds);

}  // namespace meridian::probe
