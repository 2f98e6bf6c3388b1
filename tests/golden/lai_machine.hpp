// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "golden/golden_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian::test {

/// The Lai machine of the table in a row, and the tool in it. `ending` is "_mm" or "".
struct GoldenMachine {
  MachineModel model = bench_machine();
  double tool_length_mm = 0;

  GoldenMachine(const LaiTable& constants, double tool_length) : tool_length_mm(tool_length) {
    model.lai = lai_from_table(constants);
  }

  GoldenMachine(const GoldenTable& table, std::size_t row, const std::string& ending) {
    const auto constant = [&](const char* name) { return table.number(row, name + ending); };
    model.lai = lai_from_table({.b1 = constant("b1"),
                                .a2 = constant("a2"),
                                .a3 = constant("a3"),
                                .l3 = constant("l3"),
                                .l4 = constant("l4"),
                                .b5 = constant("b5"),
                                .l5 = constant("l5")});
    tool_length_mm = constant("lt");
  }
};

[[nodiscard]] inline JointVector joints_of(const std::vector<double>& v) {
  return {v.at(0), v.at(1), v.at(2), v.at(3), v.at(4), 0};
}

[[nodiscard]] inline ToolPose pose_of(const std::vector<double>& v) {
  return {{v.at(0), v.at(1), v.at(2)}, {v.at(3), v.at(4), v.at(5)}};
}

/// The branch that joints lie on: 0 tilts into [0, π].
[[nodiscard]] inline int branch_of(const JointVector& q) { return q[4] >= 0 ? 0 : 1; }

// Tolerances of an IEEE double implementation, from the size of the numbers: lengths to 1e3 mm,
// angles to 4 rad, eps 2.2e-16, a few dozen roundings.
inline constexpr double kTipTolerance_mm = 1e-10;
inline constexpr double kAxisTolerance = 1e-14;
inline constexpr double kLinearTolerance_mm = 1e-10;
inline constexpr double kAngleTolerance_rad = 1e-12;

}  // namespace meridian::test
