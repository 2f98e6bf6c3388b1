// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian {

/// Largest tolerances that may be asked for; the least are kLeastTipTolerance_mm and
/// kLeastAxisTolerance_rad. Every edge refuses more.
inline constexpr double kMostTipTolerance_mm = 10;
inline constexpr double kMostAxisTolerance_rad = 0.17453292519943295;

}  // namespace meridian
