// SPDX-License-Identifier: Apache-2.0
#include "property/cycle/attainable_stop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "meridian/cycle/stop/stop_law.hpp"
#include "support/machines.hpp"

/// The oracle of stops itself: where limits do not tighten it is the optimum, in front of a corner
/// it keeps them.
namespace meridian::test::attainable_stop {
namespace {

/// X along the path; Y leads into a corner of `angle` at `corner`, round in about `width`.
struct Corner {
  double corner = 0, width = 1, angle = 0;

  [[nodiscard]] double end() const { return 1e6; }
  /// By Y' = angle (1 + tanh)/2, whose derivatives are polynomials of tanh.
  [[nodiscard]] Joints<Jet<3>> operator()(double s) const {
    const double x = (s - corner) / width, t = std::tanh(x), half = 0.5 * angle;
    const double y = half * width * (x + std::log(2 * std::cosh(x)));
    Joints<Jet<3>> q{};
    q[0] = Jet<3>::variable(s);
    q[1] = Jet<3>::from_derivatives({y, half * (1 + t), half * (1 - t * t) / width,
                                     -2 * half * t * (1 - t * t) / (width * width)});
    return q;
  }
};

/// The stop in closed form where X alone moves.
double straight_s(const MachineModel& machine, const PathState& begin) {
  const JointLimits& x = machine.joints[0].limits;
  return StopLaw(begin, {x.acceleration, x.jerk}).duration();
}

TEST(AttainableStop, IsTheClosedFormOnAStraightCruise) {
  const MachineModel machine = bench_machine();
  const JointLimits& x = machine.joints[0].limits;
  for (const double speed : {0.003, 0.1, 0.5, 0.999}) {
    for (const double rise : {-0.3, 0.0, 0.3}) {
      const double v = speed * x.velocity;
      const double room = std::min(v, x.velocity - v);  // of speed, to let go of it
      const double a = rise * std::min(x.acceleration, std::sqrt(room * x.jerk));
      const PathState begin{0, v, a, 0};
      const auto found = AttainableStop(machine, begin, Corner{}).find();
      ASSERT_TRUE(found) << v << ' ' << a;
      EXPECT_NEAR(found->time_s() / straight_s(machine, begin), 1, 0.01) << v << ' ' << a;
    }
  }
}

/// The programme alone, which the greediest stop saves where that is the optimum.
TEST(AttainableStop, ComesNearTheClosedFormByItsProgramme) {
  const MachineModel machine = bench_machine();
  for (const double v : {3.0, 30.0, 290.0}) {
    const PathState begin{0, v, 0, 0};
    AttainableStop oracle(machine, begin, Corner{});
    const StopMotion greediest = oracle.greedy(1);
    const auto found = oracle.solve(1.006 * greediest.length(), greediest);
    ASSERT_TRUE(found) << v;
    EXPECT_NEAR(found->time_s() / straight_s(machine, begin), 1, 0.015) << v;
    EXPECT_LE(oracle.use(*found).max(), AttainableStop<Corner>::kWithin) << v;
  }
}

TEST(AttainableStop, KeepsTheLimitsInFrontOfACornerThatTheGreediestStopBreaks) {
  const MachineModel machine = bench_machine();
  for (const double v : {20.0, 60.0, 150.0}) {
    const PathState begin{0, v, 0, 0};
    const double length = min_stop(machine, begin, Corner{}).distance_mm;
    const Corner corner{0.8 * length, 0.8 * length, 2};
    AttainableStop oracle(machine, begin, corner);
    const StopMotion greediest = oracle.greedy(1);
    EXPECT_GT(oracle.use(greediest).max(), 1.2) << v;
    const auto found = oracle.find();
    ASSERT_TRUE(found) << v;
    EXPECT_LE(oracle.use(*found).max(), AttainableStop<Corner>::kWithin) << v;
    EXPECT_GT(found->time_s(), greediest.time_s()) << v;
    EXPECT_LT(found->time_s(), 1.08 * greediest.time_s()) << v;
  }
}

TEST(AttainableStop, SaysWhereItFindsNone) {
  const MachineModel machine = bench_machine();
  const PathState begin{0, 150, 0, 0};
  const double length = min_stop(machine, begin, Corner{}).distance_mm;
  const Corner corner{0.3 * length, 0.1 * length, 2};  // no stop keeps the limits in it
  EXPECT_FALSE(AttainableStop(machine, begin, corner).find());
}

}  // namespace
}  // namespace meridian::test::attainable_stop
