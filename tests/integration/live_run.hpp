// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "integration/plant.hpp"

/// One program cut live by service, drives, station and operator, and checked by the simulation.
/// Failures are those of GoogleTest.
namespace meridian::test {

/// Options of the programs of a live run, beside the part.
struct LiveRun {
  std::string machine = "lai";          ///< one of deploy/machines, that of the plant
  std::vector<std::string> service;     ///< meridiand
  std::string settings;                 ///< more of the service file: see service_file()
  std::vector<std::string> reader;      ///< how the part is read: stream, simulate and check
  std::vector<std::string> station;     ///< stream
  std::vector<std::string> simulate;    ///< machine and workpiece: simulate and check
  std::function<void()> operate;        ///< instead of a plain start
  std::function<void()> watch = [] {};  ///< called again and again while the part is cut
  milliseconds patience{60'000};
  bool is_dry_run = false;  ///< without drives
  std::string wire;         ///< file for `meridian record` beside the station; empty: none
};

/// The small program as a CL file, with a dwell and an action in it.
void write_cl_file(const std::string& path, int blocks, const std::string& machine = "lai");

/// A service file for `plant` on a host that takes processors away: drives bridge 100 ms, and
/// feedback may be 0.3 s old. `more`: further lines of its section, and further sections.
[[nodiscard]] std::string service_file(const Plant& plant, const std::string& more = "");

/// Cuts `part` from enabling to the end of the service.
void run_live(Plant& plant, const std::string& part, const LiveRun& live);

/// Simulates `part`, with `more` on the command line: the recording's name.
[[nodiscard]] std::string simulate_part(const Plant& plant, const std::string& part,
                                        const LiveRun& live,
                                        const std::vector<std::string>& more = {});

/// The recording of the plant and `simulated` hold the same motion.
void expect_same(const Plant& plant, const std::string& simulated);

/// What came over the wire is what the service recorded of those cycles.
void expect_on_wire(const Plant& plant, const LiveRun& live);

/// The recording of the plant is `part`, inside limits and tolerances.
void expect_checked(const Plant& plant, const std::string& part, const LiveRun& live);

/// All of that without an operator's doing.
void run_and_check(Plant& plant, const std::string& part, const LiveRun& live);

}  // namespace meridian::test
