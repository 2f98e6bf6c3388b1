// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace meridian {

/// What a value may be at `t`.
struct StringWindow {
  double t = 0;
  double low = 0, high = 0;
};

/// The shortest route through `windows` (t ascends) from `begin` in the first of them to the last,
/// where the flattest end is taken: the values, one per window. Of all routes through the windows
/// it has the least integral of every convex function of its slope at once. Empty windows are
/// passed in their middle. No memory; most steps: the square of how many windows there are, between
/// two bends. Source: docs/motion.md, section 10. Proof: tests/unit/planner/taut_string_test.cpp.
void pull_taut(std::span<const StringWindow> windows, double begin,
               std::span<double> values) noexcept;

}  // namespace meridian
