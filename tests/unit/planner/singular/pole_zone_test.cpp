// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_zone.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

namespace meridian::test::pole_zone {
namespace {

constexpr FreeQuintic kWhole{0.3, -1.2, 2.5, 0.7, -0.4, 1.9};

/// The Bernstein sum, as it is defined.
double bernstein(const FreeQuintic& values, double t) {
  constexpr double kChoose[] = {1, 5, 10, 10, 5, 1};
  double sum = 0;
  for (int n = 0; n < 6; ++n) {
    sum += kChoose[n] * std::pow(t, n) * std::pow(1 - t, 5 - n) * values[n];
  }
  return sum;
}

TEST(PoleZone, PartOfAQuinticIsTheQuinticThere) {
  for (const auto& [from, to] : {std::pair{0.0, 0.4}, {0.25, 0.7}, {0.6, 1.0}, {0.0, 1.0}}) {
    const FreeQuintic part = part_of(kWhole, from, to);
    for (int k = 0; k <= 10; ++k) {
      const double t = k / 10.0;
      EXPECT_NEAR(quintic_at(part, t), bernstein(kWhole, from + t * (to - from)), 1e-13)
          << from << " to " << to << " at " << t;
    }
  }
}

TEST(PoleZone, WholeOfAQuinticIsKeptToTheBit) {
  EXPECT_EQ(part_of(kWhole, 0, 1), kWhole);
  EXPECT_EQ(part_of(kWhole, 0, 0.4)[0], kWhole[0]);
  EXPECT_EQ(part_of(kWhole, 0.6, 1)[5], kWhole[5]);
}

TEST(PoleTime, GivesAQuinticWithItsDerivativesByU) {
  constexpr double kH = 3, kStep = 1e-3;
  for (const double t : {0.1, 0.35, 0.8}) {
    const Jet<3> at = free_at(kWhole, t, kH);
    const auto f = [&](int n) { return bernstein(kWhole, t + n * kStep / kH); };
    EXPECT_NEAR(at.derivative(0), f(0), 1e-13);
    EXPECT_NEAR(at.derivative(1), (f(1) - f(-1)) / (2 * kStep), 1e-5);
    EXPECT_NEAR(at.derivative(2), (f(1) - 2 * f(0) + f(-1)) / (kStep * kStep), 1e-4);
    EXPECT_NEAR(at.derivative(3),
                (f(2) - 2 * f(1) + 2 * f(-1) - f(-2)) / (2 * kStep * kStep * kStep), 1e-3);
  }
}

/// Joints that stand still but for joint `i`, which moves by u as asked.
Joints<Jet<3>> moving(int i, double d1, double d2, double d3) {
  Joints<Jet<3>> q{};
  q[static_cast<std::size_t>(i)] = Jet<3>::from_derivatives({0.5, d1, d2, d3});
  return q;
}

TEST(PoleTime, IsTakenByWhatIsSlowest) {
  const MachineModel model = bench_machine();           // 300 mm/s, 3000 mm/s², 60000 mm/s³
  BandSpan span = leaning_span(0, {0.1, 0}, {0.1, 0});  // the tip goes 0.8 mm per mm
  const auto pose = pose_of<Jet<3>>(span, 0.5);
  const auto still = moving(0, 0, 0, 0);
  EXPECT_NEAR(slowness(model, span, pose, still), 0.8 / 50, 1e-15);
  span.u_speed_mm_per_s = 20;
  EXPECT_NEAR(slowness(model, span, pose, still), 1.0 / 20, 1e-15);
  EXPECT_NEAR(slowness(model, span, pose, moving(0, -30, 0, 0)), 0.1, 1e-15);
  EXPECT_NEAR(slowness(model, span, pose, moving(1, 0, -120, 0)), 0.2, 1e-15);
  EXPECT_NEAR(slowness(model, span, pose, moving(2, 0, 0, -480)), 0.2, 1e-15);
  EXPECT_NEAR(slowness(model, span, pose, moving(2, 0, 1e-3, 1e-3)), 1.0 / 20, 1e-15);
}

TEST(PoleTime, TakesThePoseOfASpanNoFartherThanItsEnds) {
  const BandSpan span = leaning_span(3, {0.1, 0}, {0.2, 0});
  EXPECT_NEAR(pose_of<double>(span, 3.25).tip[0], 0.8 * 3.25, 1e-12);
  EXPECT_NEAR(pose_of<double>(span, 2).tip[0], 0.8 * 3, 1e-12);
  EXPECT_NEAR(pose_of<double>(span, 9).tip[0], 0.8 * 4, 1e-12);
}

}  // namespace
}  // namespace meridian::test::pole_zone
