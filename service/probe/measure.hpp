// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meridian/rt/histogram.hpp"
#include "service/probe/figures.hpp"

/// What a host can do for Meridian, measured by turns of the service and of bare programs.
namespace meridian::probe {

struct MeasureOptions {
  std::string machine;              ///< its file
  std::vector<int> rates_hz{1000};  ///< the machine's cycle is changed to each in turn
  int turns = 10;                   ///< of 1 s, of each kind
  std::uint32_t domain = 0;
  bool has_load = false;  ///< measure once more under a load made here
};

/// All that was measured at one rate, with or without load.
struct RateMeasurement {
  int rate_hz = 0;
  bool is_loaded = false;
  Turns lateness{"service, lateness of cycle"}, bare_wake{"bare thread, lateness"};
  Turns one_way{"service, computed to seen"}, bare_one_way{"bare ping, one way"};
  Histogram round_trip;  ///< service: sent until the drives' answer is here
  Turns bare_round_trip{"bare ping, round trip"};
  Turns computation{"service, cycle computation"};
  Histogram wake;  ///< service: waking the publisher
  std::optional<Histogram> cyclictest;
  std::uint64_t sent = 0, unseen = 0;   ///< setpoints in the turns
  std::uint64_t lost_periods = 0;       ///< of the service in its turns
  std::uint64_t bare_lost_periods = 0;  ///< of the bare thread in its turns
  double stolen_ms = 0;                 ///< processor time that the host took away meanwhile
  std::string broken_off;               ///< why the program was not cut to its end; empty: it was
};

/// Memory that this host has left, MiB.
[[nodiscard]] double available_mib();

/// Why a measurement cannot be held in half of `available_mib`, with what can; empty: it can.
/// Proof: tests/unit/probe/probe_report_test.cpp.
[[nodiscard]] std::string too_large(const MeasureOptions& options, double available_mib);

/// Measures; `say` hears what is being done. Throws std::runtime_error or dds::DdsError where a
/// program does not run.
[[nodiscard]] std::vector<RateMeasurement> measure(
    const MeasureOptions& options, const std::function<void(const std::string&)>& say);

/// The text of a machine file with another cycle time; throws std::runtime_error where it names
/// none. Proof: tests/unit/probe/probe_report_test.cpp.
[[nodiscard]] std::string with_cycle_us(const std::string& machine_text, std::int64_t cycle_us);

}  // namespace meridian::probe
