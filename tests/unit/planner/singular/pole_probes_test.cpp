// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_probes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

namespace meridian::test::pole_probes {
namespace {

/// From 0.1 on one side to 0.1 on the other, 0.01 beside the pole; nearest at u = 20.3.
Lean passing(double u) { return {0.005 * (u - 20.3), 0.01}; }
double distance(double u) { return std::atan(std::hypot(passing(u).x, passing(u).y)); }

struct Probed {
  explicit Probed(int count, bool is_probing = true) {
    probes.begin(is_probing);
    for (const BandSpan& span : leaning_path(count, passing)) probes.push(span);
  }
  MachineModel model = bench_machine();
  PoleProbes probes{model};
};

TEST(PoleProbes, LieAtEqualStepsOfEverySpan) {
  const Probed probed(40);
  const PoleProbes& probes = probed.probes;
  ASSERT_EQ(probes.begin_probe(), 0);
  ASSERT_EQ(probes.end_probe(), 40 * PoleProbes::kProbes);
  for (PoleProbes::ProbeIndex n = 0; n < probes.end_probe(); ++n) {
    const double u = static_cast<double>(n) / PoleProbes::kProbes;
    EXPECT_NEAR(probes.u_of(n), u, 1e-12);
    EXPECT_NEAR(probes.distance_of(n), distance(u), 1e-9) << u;
  }
  EXPECT_EQ(probes.end_u(), 40);
}

TEST(PoleProbes, KnowTheDistanceBetweenThemAndWhereItIsLeast) {
  const Probed probed(40);
  for (const double u : {0.0, 3.37, 20.3, 39.99, 40.0}) {
    EXPECT_NEAR(probed.probes.distance_at(u), distance(u), 1e-12) << u;
  }
  EXPECT_NEAR(probed.probes.distance_at(41), distance(40), 1e-12) << "no farther than the path";
  const PoleProbes::ProbeIndex nearest = 20 * PoleProbes::kProbes + 2;  // at 20.33
  EXPECT_NEAR(probed.probes.find_nearest(nearest), 20.3, 1e-6);
  EXPECT_NEAR(probed.probes.find_nearest(nearest - 1), 20.3, 1e-6);
  EXPECT_NEAR(probed.probes.find_nearest(nearest - 2), 20 + 1.0 / 6, 1e-6)
      << "between its neighbours alone";
  EXPECT_NEAR(probed.probes.find_nearest(nearest + 6), 21 + 1.0 / 6, 1e-6);
}

TEST(PoleProbes, LookNoFartherThanThePath) {
  const Probed probed(20);  // it ends before the nearest point
  EXPECT_NEAR(probed.probes.find_nearest(20 * PoleProbes::kProbes - 1), 20, 1e-6);
  Probed after(40);
  for (int n = 0; n < 25; ++n) after.probes.drop_front();
  EXPECT_NEAR(after.probes.find_nearest(after.probes.begin_probe()), 25, 1e-6);
}

TEST(PoleProbes, FindTheSpanOfAnyPlace) {
  Probed probed(40);
  EXPECT_EQ(probed.probes.span_at(0).sequence, 0U);
  EXPECT_EQ(probed.probes.span_at(7.5).sequence, 7U);
  EXPECT_EQ(probed.probes.span_at(8).sequence, 8U);
  EXPECT_EQ(probed.probes.span_at(99).sequence, 39U);
  EXPECT_EQ(probed.probes.front().sequence, 0U);
  for (int n = 0; n < 5; ++n) probed.probes.drop_front();
  EXPECT_EQ(probed.probes.front().sequence, 5U);
  EXPECT_EQ(probed.probes.begin_probe(), 5 * PoleProbes::kProbes);
  EXPECT_EQ(probed.probes.span_at(2).sequence, 5U);
  EXPECT_NEAR(probed.probes.u_of(probed.probes.begin_probe() + 2), 5 + 2.0 / 6, 1e-12);
}

TEST(PoleProbes, KnowTheLeastDistanceOnTheFrontSpan) {
  Probed probed(40);
  EXPECT_NEAR(probed.probes.front_distance(), distance(5.0 / 6), 1e-12);
  for (int n = 0; n < 25; ++n) probed.probes.drop_front();
  EXPECT_NEAR(probed.probes.front_distance(), distance(25), 1e-12);
}

TEST(PoleProbes, MeasureNothingWhereThePoleDoesNotMatter) {
  const Probed probed(40, false);
  EXPECT_EQ(probed.probes.distance_of(7), 0);
  EXPECT_EQ(probed.probes.end_probe(), 40 * PoleProbes::kProbes);
}

TEST(PoleProbes, BeginAgainWithoutSpans) {
  Probed probed(40);
  EXPECT_FALSE(probed.probes.is_empty());
  EXPECT_FALSE(probed.probes.is_full());
  probed.probes.begin(true);
  EXPECT_TRUE(probed.probes.is_empty());
  EXPECT_EQ(probed.probes.end_probe(), 0);
}

}  // namespace
}  // namespace meridian::test::pole_probes
