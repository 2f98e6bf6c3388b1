// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>

#include "meridian/cycle/histogram.hpp"
#include "service/host/probe/run/service_setup.hpp"
#include "service/host/probe/turn_figures.hpp"

namespace meridian::probe {

/// What the service did while a program ran.
struct WorkResult {
  TurnFigures turns;       ///< from its first motion to its last, cut into turns
  Histogram wake;          ///< waking the publisher, on the cycle thread
  std::string broken_off;  ///< why the program was not cut for that long; empty: it was
};

/// Lets service, simulated drives and station cut a program that moves every joint, for `seconds`
/// at most, with this process listening to the setpoints beside the drives. Everything runs as
/// processes. A machine that a host like this one takes to Fault is a result. Throws Interrupted,
/// and std::runtime_error with what the service said where it does not end as it should.
[[nodiscard]] WorkResult run_work(const ServiceSetup& setup, double seconds,
                                  const std::atomic<bool>& is_stopping);

}  // namespace meridian::probe
