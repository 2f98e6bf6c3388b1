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
};

/// Lets service, simulated drives and station cut a program that moves every joint, for `seconds`
/// at most. Everything runs as processes in `folder`; `machine` is the machine file. Throws
/// std::runtime_error with what a program said where one of them fails.
[[nodiscard]] WorkResult run_work(std::uint32_t domain, const std::filesystem::path& folder,
                                  const std::string& machine, const std::string& name,
                                  std::int64_t period_ns, double seconds);

}  // namespace meridian::probe
