// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "service/core/planner/singular/pole/pole_stretches.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

/// Paths past the pole, and the stretches of them that are close to it.
namespace meridian::test::pole_stretches {

using Answer = PoleStretches::Answer;

/// Close to the pole is what is nearer than 0.005 rad; a path is waited for up to 0.01 rad.
inline constexpr double kTolerance_rad = 0.002;
inline constexpr double kProbe_mm = 1.0 / PoleProbes::kProbes;

/// Past the pole at `at`, `beside` off it: 0.004 rad a mm.
inline auto passing(double beside, double at = 60) {
  return [=](double u) { return Lean{0.004 * (u - at), beside}; };
}

/// Stretches of a path, as far as it is pushed.
struct Stretched {
  template <class LeanAt>
  Stretched(int count, const LeanAt& lean, int pushed = 1000) : path(leaning_path(count, lean)) {
    probes.begin(true);
    stretches.begin(kTolerance_rad);
    push(std::min(count, pushed));
    settled.is_whole = pushed >= count;
  }
  void push(int count) {
    for (int n = 0; n < count; ++n) probes.push(path[next++]);
  }
  /// The answer at the next place; nothing found counts as kNeedsSpans.
  Answer ask() {
    return stretches.find_next(settled) ? stretches.decide(out) : Answer::kNeedsSpans;
  }

  MachineModel model = bench_machine();
  std::vector<BandSpan> path;
  std::size_t next = 0;
  PoleProbes probes{model};
  PoleStretches stretches{probes};
  SettledPath settled;
  PoleStretch out;
};

/// Close to the pole at 60 and at 70; `peak` off it between them.
inline auto twice(double peak) {
  return [peak](double u) {
    if (u <= 60) return Lean{0.004 * (u - 60), 0.0005};
    if (u >= 70) return Lean{0.004 * (u - 70), 0.0005};
    return Lean{peak * (1 - std::abs(u - 65) / 5), 0.0005};
  };
}

}  // namespace meridian::test::pole_stretches
