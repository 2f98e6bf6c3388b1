// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/units.hpp"

namespace meridian::config {

/// A closed range of numbers in the unit of the key. Open ends are the largest double.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
};

/// What a length, and a length that cannot be nothing, may be in any machine file, mm.
inline constexpr Range kLength_mm{-1e5, 1e5};
inline constexpr Range kPositive_mm{1e-3, 1e5};

/// Tolerances of smooth runs, in machine files and on command lines.
inline constexpr Range kTipTolerance_mm{kMinTipTolerance_mm, kMaxTipTolerance_mm};
inline constexpr Range kAxisTolerance_deg{0.00573, 10};
static_assert(units::rad_from_deg(kAxisTolerance_deg.low) >= kMinAxisTolerance_rad);
static_assert(units::rad_from_deg(kAxisTolerance_deg.high) == kMaxAxisTolerance_rad);

/// The same in machine files whose programs end their cuts at rest: nothing is smoothed by them.
inline constexpr Range kRestTipTolerance_mm{1e-6, kTipTolerance_mm.high};
inline constexpr Range kRestAxisTolerance_deg{1e-6, kAxisTolerance_deg.high};

}  // namespace meridian::config
