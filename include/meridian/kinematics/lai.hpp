// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian {

/// The machine of Lai et al.: table turning about C, head tilting by ±60°, joints b3, b2, b4,
/// theta1, theta2. Only three constants of its Denavit-Hartenberg table are identifiable besides
/// the tool length lt: the tool tip is l = pivot_mm + lt below the tilt axis (docs/kinematics.md).
struct LaiKinematics {
  double pivot_mm = 0;  ///< l5: tilt axis to gauge line
  double e_mm = 0;      ///< a3 + b5 + l4
  double h_mm = 0;      ///< l3 + a2 - b1
};

/// Constants of the Denavit-Hartenberg table, named as in the paper; signs as in the corrected
/// table, docs/kinematics.md, table 2.1. Unit: mm.
struct LaiTable {
  double b1 = 0, a2 = 0, a3 = 0, l3 = 0, l4 = 0, b5 = 0, l5 = 0;
};

/// Returns what of the table can be measured from outside, eq. 2.1. Proof: tests/golden.
[[nodiscard]] constexpr LaiKinematics lai_from_table(const LaiTable& table) noexcept {
  return {.pivot_mm = table.l5,
          .e_mm = table.a3 + table.b5 + table.l4,
          .h_mm = table.l3 + table.a2 - table.b1};
}

}  // namespace meridian
