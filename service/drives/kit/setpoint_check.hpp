// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/kit/csp/cia402.hpp"

namespace meridian::drive {

/// A setpoint that one drive is to follow, and what it is checked against. Units: mm or rad, s.
struct CheckedSetpoint {
  double position = 0, velocity = 0;
  bool is_fault_stop = false;  ///< kSetpointFaultStop: may end outside of travel
  bool has_begun = false;      ///< the drive follows already
  double from = 0;             ///< last setpoint that it accepted; before the first: its position
  double elapsed_s = 0;        ///< since that setpoint
  bool is_referenced = true;   ///< else positions mean nothing, and travel is not checked
};

inline constexpr double kBeyondAnything = 1e9;   ///< mm or rad, and per second: no such machine
inline constexpr double kVelocityMargin = 0.02;  ///< share of the limit: rounding, lost periods
inline constexpr double kStepMargin = 1e-6;      ///< mm or rad; the service's guard uses 1e-9
inline constexpr double kBeginShare = 0.5;       ///< of the following error: step at the begin

/// How far a joint may run out of travel in a FaultStop that begins at its edge with full speed:
/// what its drives bridge, at most 0.1 s, and the ramp.
[[nodiscard]] inline double run_out(const JointLimits& limits) noexcept {
  constexpr double kBridged_s = 0.1;
  if (!(limits.fault_acceleration > 0)) return kBeyondAnything;
  return limits.velocity * kBridged_s +
         limits.velocity * limits.velocity / (2 * limits.fault_acceleration);
}

/// Why the drive refuses the setpoint, as libfranka's robots do: object 603Fh; kErrorNone: it
/// follows. Limits that are 0 are not checked. Acceleration is not checked: the drives' own limits
/// are those of a FaultStop, and the step is. Proof: tests/unit/drive_kit/setpoint_check_test.cpp.
[[nodiscard]] inline std::uint16_t check_setpoint(const JointSpec& drive,
                                                  const CheckedSetpoint& asked) noexcept {
  const JointLimits& limits = drive.limits;
  const double q = asked.position, step = std::abs(q - asked.from);
  const bool is_number =
      std::abs(q) < kBeyondAnything && std::abs(asked.velocity) < kBeyondAnything;
  if (!is_number) return kErrorSetpointNoNumber;
  const double fastest = limits.velocity > 0 ? limits.velocity * (1 + kVelocityMargin) : INFINITY;
  if (std::abs(asked.velocity) > fastest + kStepMargin) return kErrorSetpointVelocity;
  if (!drive.is_endless && asked.is_referenced && limits.travel_min < limits.travel_max) {
    // Who stands outside may come back, and stand.
    const double beyond = kStepMargin + (asked.is_fault_stop ? run_out(limits) : 0);
    const double lowest = std::min(limits.travel_min - beyond, asked.from - kStepMargin);
    const double highest = std::max(limits.travel_max + beyond, asked.from + kStepMargin);
    if (q < lowest || q > highest) return kErrorSetpointTravel;
  }
  if (!asked.has_begun) {
    const bool is_apart =
        limits.following_error > 0 && step > kBeginShare * limits.following_error + kStepMargin;
    return is_apart ? kErrorSetpointBegin : kErrorNone;
  }
  return step > fastest * asked.elapsed_s + kStepMargin ? kErrorSetpointStep : kErrorNone;
}

}  // namespace meridian::drive
