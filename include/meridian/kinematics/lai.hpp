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

}  // namespace meridian
