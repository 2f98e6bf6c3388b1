// SPDX-License-Identifier: Apache-2.0

/// Where the exact path leads past the pole: how its spans are cut about the nearest point.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/machines.hpp"
#include "unit/planner/singular/handed_path.hpp"

namespace meridian::test::pole_cuts {
namespace {

using pole_corridor::expect_whole;
using pole_corridor::Handed;

/// Distances from `nearest` at which spans are cut behind it, and ahead of it, ascending.
struct Cuts {
  std::vector<double> ahead, behind;
  bool is_at_nearest = false;
};

/// Of a path whose axis turns by `rate` a mm, `beside` off the pole at `nearest`.
Cuts cuts_of(double beside, double rate, double nearest) {
  MachineModel model = bench_machine();
  model.pole_policy = PolePolicy::kExact;
  Handed handed(model, leaning_path(120, [=](double u) {
                  return Lean{rate * (u - nearest), beside};
                }));
  handed.run();
  EXPECT_FALSE(handed.corridor.has_failed());
  expect_whole(handed);
  Cuts cuts;
  for (const JointSpan& span : handed.out) {
    const double u = span.band.u0, off = u - nearest;
    if (std::abs(off) < 1e-6) cuts.is_at_nearest = true;
    if (std::abs(u - std::round(u)) < 1e-7 || std::abs(off) < 1e-6) continue;
    (off < 0 ? cuts.ahead : cuts.behind).push_back(std::abs(off));
  }
  std::sort(cuts.ahead.begin(), cuts.ahead.end());
  return cuts;
}

TEST(PoleCuts, LieTheSameOnBothSidesAndGrowByAHalf) {
  for (const double beside : {5e-4, 1e-4, 2e-5}) {
    const Cuts cuts = cuts_of(beside, 0.02, 60);
    ASSERT_GT(cuts.behind.size(), 12U);
    ASSERT_EQ(cuts.ahead.size(), cuts.behind.size()) << beside;
    EXPECT_NEAR(cuts.behind.front(), 0.25 * beside / 0.02, 0.01 * beside / 0.02);
    for (std::size_t n = 0; n < cuts.behind.size(); ++n) {
      EXPECT_NEAR(cuts.ahead[n], cuts.behind[n], 1e-6);
      if (n > 0) {
        EXPECT_NEAR(cuts.behind[n] / cuts.behind[n - 1], 1.5, 1e-3) << n;
      }
    }
    EXPECT_LT(cuts.behind.back(), 5);
    EXPECT_GT(1.5 * cuts.behind.back(), 5) << "as far as that";
  }
}

TEST(PoleCuts, LieAtTheNearestPointToo) { EXPECT_TRUE(cuts_of(1e-4, 0.02, 60.4).is_at_nearest); }

TEST(PoleCuts, AreNoMoreThanTwentyEightOnEitherSide) {
  const Cuts cuts = cuts_of(1e-5, 0.1, 60);
  EXPECT_EQ(cuts.ahead.size(), 28U);
  EXPECT_EQ(cuts.behind.size(), 28U);
}

}  // namespace
}  // namespace meridian::test::pole_cuts
