// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/histogram.hpp"
#include "service/host/probe/figures.hpp"
#include "service/host/probe/run/service_setup.hpp"
#include "service/host/probe/turn_figures.hpp"
#include "service/machine/file/sections/service_file.hpp"

/// What a host can do for Meridian, measured by turns of the service and of bare programs.
namespace meridian::probe {

struct MeasureOptions {
  std::string machine;              ///< its file
  std::vector<int> rates_hz{1000};  ///< the machine's cycle is changed to each in turn
  int turns = 10;                   ///< of 1 s, of each kind
  std::uint32_t domain = 0;
  bool has_load = false;            ///< measure once more under a load made here
  config::RealtimeConfig realtime;  ///< of the service that will serve here
};

/// All that was measured at one rate, with or without load. The service is measured twice: in Off,
/// where it takes turns with the bare programs, and while it cuts a program with simulated drives
/// and a station beside it. Latenesses hold those of the periods that were slept through.
struct RateMeasurement {
  int rate_hz = 0;
  bool is_loaded = false;
  Turns lateness{"Off: lateness of cycle"}, bare_wake{"bare thread: lateness"};
  Turns one_way{"Off: computed to seen"}, bare_one_way{"bare ping: one way"};
  Histogram round_trip;  ///< service in Off: sent until the drives' answer is here
  Turns bare_round_trip{"bare ping: round trip"};
  Turns cutting_lateness{"cutting: lateness of cycle"},
      cutting_one_way{"cutting: computed to seen"};
  Turns computation{"cutting: cycle computation"};
  Histogram wake;  ///< service, cutting: waking the publisher
  std::optional<Histogram> cyclictest;
  std::uint64_t periods = 0;                    ///< of the turns of each kind
  std::uint64_t moving = 0;                     ///< cycles that moved the machine
  Missing lost, bare_lost, cutting_lost;        ///< periods that nobody executed
  Missing unseen, bare_unseen, cutting_unseen;  ///< setpoints and pings that never came
  std::uint64_t untimed = 0;    ///< cycles of which the recording does not say how long they took
  double stolen_ms = 0;         ///< processor time that the host took away meanwhile
  std::string broken_off;       ///< why the program was not cut to its end; empty: it was
  bool is_interrupted = false;  ///< somebody wanted no more of it
};

/// Memory that this host has left, MiB.
[[nodiscard]] double available_mib();

/// Why a measurement cannot be held in half of `available_mib`, with what can; empty: it can.
/// Proof: tests/unit/probe/probe_report_test.cpp.
[[nodiscard]] std::string too_large(const MeasureOptions& options, double available_mib);

/// The processor of the cycle: as the service file says, else the last of those that this process
/// was given, as the service chooses. Takes it where it was kept from us; throws std::runtime_error
/// where we may not have it.
[[nodiscard]] int cycle_cpu(const config::RealtimeConfig& realtime);

/// Who hears what is being done, and gets each measurement as soon as it is there.
struct Audience {
  std::function<void(const std::string&)> say;
  std::function<void(const RateMeasurement&)> take;
};

/// Turns of the service in Off, the bare thread and the bare ping, one after the other on the CPU
/// of `setup`, added to `measured`. Throws as measure().
void take_turns(const ServiceSetup& setup, int turns, const std::atomic<bool>& is_stopping,
                RateMeasurement& measured);

/// Measures until all is measured or `is_stopping`: what was under way then is marked interrupted.
/// Throws std::runtime_error or dds::DdsError where a program does not run.
void measure(const MeasureOptions& options, const std::atomic<bool>& is_stopping,
             const Audience& audience);

/// The text of a machine file with another cycle time; throws std::runtime_error where it names
/// none. Proof: tests/unit/probe/probe_report_test.cpp.
[[nodiscard]] std::string with_cycle_us(const std::string& machine_text, std::int64_t cycle_us);

}  // namespace meridian::probe
