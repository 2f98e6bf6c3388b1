// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

/// House units are millimetre, radian, second. These are the only conversions of the code base;
/// they are called at the edges (files, wire, command line), never between rooms of the core.
namespace meridian::units {

inline constexpr double kDegree_rad = std::numbers::pi / 180.0;
inline constexpr double kInch_mm = 25.4;
inline constexpr double kMinute_s = 60.0;

[[nodiscard]] constexpr double rad_from_deg(double deg) noexcept { return deg * kDegree_rad; }
[[nodiscard]] constexpr double deg_from_rad(double rad) noexcept { return rad / kDegree_rad; }
[[nodiscard]] constexpr double mm_from_inch(double inch) noexcept { return inch * kInch_mm; }
[[nodiscard]] constexpr double per_s_from_per_min(double per_min) noexcept {
  return per_min / kMinute_s;
}
[[nodiscard]] constexpr double per_min_from_per_s(double per_s) noexcept {
  return per_s * kMinute_s;
}

}  // namespace meridian::units
