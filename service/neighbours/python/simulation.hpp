// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/analysis/simulate/simulate_report.hpp"
#include "service/neighbours/python/machine.hpp"

namespace meridian::python {

/// How a program is simulated, where not as machine and file say.
struct SimulationOptions {
  std::string tools, transition, dialect, units;
  std::optional<double> feed_mm_per_min, unknown_tool_length_mm;
  double tip_tolerance_mm = 0, axis_tolerance_deg = 0;
};

/// A simulated run: what came of it, and every cycle that drives would get. One row a cycle.
struct Simulation {
  simulate::SimulateReport report;
  std::string text;  ///< the report of `meridian simulate`
  int joint_count = 0;
  std::vector<double> joints;  ///< machine order
  std::vector<double> drives;  ///< drive order, behind the stage of a machine that has one
  std::vector<double> velocities, plan_times;
  std::vector<std::int64_t> cycles, lines;
  std::vector<std::uint8_t> kinds, states;
};

/// Runs the program in `file` as `meridian simulate` does, bit for bit. Throws
/// std::invalid_argument with every finding where the file cannot be run on the machine.
[[nodiscard]] Simulation simulate_file(const std::string& file, const Machine& machine,
                                       const SimulationOptions& options);

}  // namespace meridian::python
