// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/planner/rate_limits.hpp"
#include "meridian/planner/rate_room.hpp"

/// Rest to rest along one path, jerk-limited. Units: mm, s.
///
///     s'''  +J ▄▄          ▄▄            seven phases, durations
///              ██            ██          tj ta tj tv tj ta tj
///            ──  ──▄▄────▄▄──  ──
///                  ▀▀    ▀▀  -J
///     s''     ╱▔▔╲
///            ╱    ╲______      ______
///                        ╲    ╱
///                         ╲▁▁╱
///     s'         ╱▔▔▔▔▔▔╲
///           ____╱        ╲____
namespace meridian {

/// Bounds of the motion on a path piece: whatever s(t) keeps all three keeps the joints' limits.
struct PathLimits {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// A symmetric seven-phase motion from rest to rest.
struct Profile {
  double jerk = 0;
  double jerk_time = 0;    ///< tj
  double accel_time = 0;   ///< ta
  double cruise_time = 0;  ///< tv

  [[nodiscard]] double peak_acceleration() const noexcept { return jerk * jerk_time; }
  [[nodiscard]] double peak_velocity() const noexcept {
    return jerk * jerk_time * (jerk_time + accel_time);
  }
  [[nodiscard]] double length() const noexcept {
    return peak_velocity() * (2 * jerk_time + accel_time + cruise_time);
  }
  [[nodiscard]] double duration() const noexcept {
    return 4 * jerk_time + 2 * accel_time + cruise_time;
  }
};

/// Returns the fastest rest-to-rest motion over `length` inside `limits`. `length` and all limits
/// are positive. Its length() equals `length` to rounding.
/// Proof: tests/unit/planner/profile_test.cpp.
[[nodiscard]] inline Profile rest_to_rest(double length, const PathLimits& limits) noexcept {
  const double v_max = limits.velocity, a_max = limits.acceleration, j_max = limits.jerk;
  const double v_round = a_max * a_max / j_max;  // reached when acceleration just touches a_max
  Profile p;
  const auto accelerate_to = [&](double v) {
    if (v >= v_round) {
      p.jerk_time = a_max / j_max;
      p.accel_time = std::max(0.0, v / a_max - p.jerk_time);
    } else {
      p.jerk_time = std::sqrt(v / j_max);
      p.accel_time = 0;
    }
  };
  accelerate_to(v_max);
  const double ramps = v_max * (2 * p.jerk_time + p.accel_time);
  if (ramps <= length) {
    p.cruise_time = (length - ramps) / v_max;
  } else if (const double v =
                 2 * a_max * length / (v_round + std::sqrt(v_round * v_round + 4 * a_max * length));
             v >= v_round) {
    accelerate_to(v);
  } else {
    p.jerk_time = std::cbrt(length / (2 * j_max));
    p.accel_time = 0;
  }
  // Phases of no weight are dropped; the jerk makes the length exact again.
  if (p.accel_time < 1e-9 * p.jerk_time) p.accel_time = 0;
  if (p.cruise_time < 1e-9 * (p.jerk_time + p.accel_time)) p.cruise_time = 0;
  p.jerk = length / (p.jerk_time * (p.jerk_time + p.accel_time) *
                     (2 * p.jerk_time + p.accel_time + p.cruise_time));
  return p;
}

inline const RateRoom kRoomOfAcceleration =
    RateRoom::of_acceleration(kRateSlope_per_s, kRateCurvature_per_s2);
inline const RateRoom kRoomOfJerk = RateRoom::of_jerk(kRateSlope_per_s, kRateCurvature_per_s2);

/// What the rate filter leaves of `limits` where a motion has the velocity `v` and the acceleration
/// `a` (rate_room.hpp).
[[nodiscard]] inline PathLimits limits_beside_rate(const PathLimits& limits, double v,
                                                   double a) noexcept {
  return {limits.velocity, kRoomOfAcceleration.within(limits.acceleration, v),
          kRoomOfJerk.within(limits.jerk - kRateCurvature_per_s2 * v, 3 * a)};
}

/// As rest_to_rest(), with the reserve that the rate filter needs (rate_limits.hpp): all overrides
/// of the motion keep `limits`. Nothing (jerk 0) where the reserve leaves no acceleration or jerk.
/// Proof: tests/unit/planner/profile_test.cpp.
[[nodiscard]] inline Profile rest_to_rest_with_reserve(double length,
                                                       const PathLimits& limits) noexcept {
  // The more acceleration and jerk a motion may use, the more it reaches and the more reserve it
  // needs: from an upper estimate every second step errs on the safe side.
  Profile p = rest_to_rest(length, limits);
  for (int n = 0; n < 3; ++n) {
    const PathLimits left = limits_beside_rate(limits, p.peak_velocity(), p.peak_acceleration());
    if (!(left.acceleration > 0) || !(left.jerk > 0)) return {};
    p = rest_to_rest(length, left);
  }
  return p;
}

/// One phase of constant jerk: its start and how long it lasts.
struct ProfilePhase {
  double duration = 0;
  double s = 0, v = 0, a = 0, j = 0;
};

/// The phases of a profile that last, in order.
struct ProfilePhases {
  std::array<ProfilePhase, 7> phase;
  int count = 0;
};

/// Returns the phases of `profile` over `length`. Those that slow down are computed from the end,
/// so that the last one ends on `length` at rest to rounding.
[[nodiscard]] inline ProfilePhases phases_of(const Profile& profile, double length) noexcept {
  const double tj = profile.jerk_time, ta = profile.accel_time, j = profile.jerk;
  const double a = profile.peak_acceleration(), v = profile.peak_velocity();
  const double s1 = j * tj * tj * tj / 6, v1 = j * tj * tj / 2;
  const double s2 = s1 + ta * (v1 + a * ta / 2), v2 = v1 + a * ta;
  const double s3 = v * (2 * tj + ta) / 2;
  ProfilePhases out;
  const auto add = [&out](const ProfilePhase& phase) {
    if (phase.duration > 0) out.phase[out.count++] = phase;
  };
  add({tj, 0, 0, 0, j});
  add({ta, s1, v1, a, 0});
  add({tj, s2, v2, a, -j});
  add({profile.cruise_time, s3, v, 0, 0});
  add({tj, length - s3, v, 0, -j});
  add({ta, length - s2, v2, -a, 0});
  add({tj, length - s1, v1, -a, j});
  return out;
}

}  // namespace meridian
