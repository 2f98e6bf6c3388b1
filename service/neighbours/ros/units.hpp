// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/kinematics/machine_model.hpp"

/// ROS counts in m, rad and s (REP 103), the house in mm, rad and s. Digits that no encoder has
/// would make half of a file, because nothing packs them: they are rounded away, to powers of two.
namespace meridian::ros {

[[nodiscard]] inline double rounded(double value, int binary_places) noexcept {
  return std::ldexp(std::nearbyint(std::ldexp(value, binary_places)), -binary_places);
}

inline constexpr int kPositionPlaces = 30;  ///< steps of 1e-9 m or rad, of what is sent
inline constexpr int kFeedbackPlaces = 27;  ///< 7.5e-9 m or rad
inline constexpr int kVelocityPlaces = 20;  ///< 1e-6 m/s or rad/s
inline constexpr int kAxisPlaces = 20;      ///< 1e-6, of a unit vector
inline constexpr int kScreenPlaces = 20;    ///< 1e-6 m, or of a unit quaternion: of pictures
inline constexpr int kTimePlaces = 20;      ///< 1e-6 s
inline constexpr int kSharePlaces = 12;     ///< 2.4e-4 of a limit

[[nodiscard]] inline float rounded_float(double value, int binary_places) noexcept {
  return static_cast<float>(rounded(value, binary_places));
}

[[nodiscard]] inline double m_from_mm(double mm) noexcept { return mm * 1e-3; }
/// Of a joint's or a drive's position or velocity.
[[nodiscard]] inline double in_ros_units(const JointSpec& spec, double value) noexcept {
  return spec.is_rotary ? value : m_from_mm(value);
}

}  // namespace meridian::ros
