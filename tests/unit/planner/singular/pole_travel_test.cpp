// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_travel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/singular/pole/pole_probes.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/leaning_path.hpp"

namespace meridian::test::pole_travel {
namespace {

/// Twice round the pole, 0.1 off it, a quarter turn every 10 mm.
Lean round(double u) {
  const double angle = std::numbers::pi / 20 * u;
  return {0.1 * std::cos(angle), 0.1 * std::sin(angle)};
}

struct Followed {
  template <class LeanAt>
  explicit Followed(const LeanAt& lean, int count = 60) {
    probes.begin(true);
    for (const BandSpan& span : leaning_path(count, lean)) probes.push(span);
    programmed.begin(Vector3::UnitZ());
    pass.end = 5;
    pass.known_end = count;
  }
  [[nodiscard]] JointVector joints_at(double u, int branch) const {
    return solve(model, 100, pose_of<double>(probes.span_at(u), u), branch, {}).q;
  }
  [[nodiscard]] RouteAfter from(double u, int branch) const {
    const PoleTask task{model, probes, programmed, 100, 0.001};
    return follow_after(task, pass, u, joints_at(u, branch), branch);
  }

  MachineModel model = bench_machine();
  PoleProbes probes{model};
  ProgrammedAxis programmed;
  PolePass pass;
};

TEST(PoleTravel, FollowsTheRedundantJointToTheEndThatIsKnown) {
  Followed path(round);
  for (const int branch : {0, 1}) {
    const RouteAfter route = path.from(2, branch);
    EXPECT_TRUE(route.keeps_travel);
    EXPECT_TRUE(route.is_to_end);
    const double turn = route.free - path.joints_at(2, branch)[3];
    EXPECT_NEAR(std::abs(turn), 58 * std::numbers::pi / 20, 0.02) << "windings are kept";
  }
  path.pass.known_end = 12;
  const double turn = path.from(2, 0).free - path.joints_at(2, 0)[3];
  EXPECT_NEAR(std::abs(turn), 10 * std::numbers::pi / 20, 0.02);
}

TEST(PoleTravel, SaysWhereAJointLeavesTravel) {
  Followed path(round);
  const double begin = path.joints_at(2, 0)[3];
  const double end = path.from(2, 0).free;
  path.model.joints[3].is_endless = false;
  JointLimits& limits = path.model.joints[3].limits;
  limits.travel_min = std::min(begin, end) - 0.01;
  limits.travel_max = std::max(begin, end) + 0.01;
  EXPECT_TRUE(path.from(2, 0).keeps_travel);
  (end > begin ? limits.travel_max : limits.travel_min) += end > begin ? -0.02 : 0.02;
  EXPECT_FALSE(path.from(2, 0).keeps_travel);
}

TEST(PoleTravel, StopsWhereThePathComesCloseToThePoleAgain) {
  // Straight over the pole at u = 40, closer than three tolerances from 38.5 on.
  const auto lean = [](double u) { return Lean{0.002 * (40 - u), 0}; };
  Followed path(lean);
  const RouteAfter route = path.from(6, 0);
  EXPECT_TRUE(route.keeps_travel);
  EXPECT_FALSE(route.is_to_end);
  EXPECT_NEAR(route.free, path.joints_at(6, 0)[3], 1e-9);
  path.pass.end = 60;  // all of it is ahead of the stretch's end
  EXPECT_TRUE(path.from(6, 0).is_to_end || !path.from(6, 0).keeps_travel);
}

TEST(PoleTravel, SeesATurnThatIsSharperThanItsSteps) {
  // Past the pole at 0.004, half a turn within a few tenths of a millimetre.
  const auto lean = [](double u) { return Lean{0.02 * (u - 30.1), 0.004}; };
  Followed path(lean);
  const double begin = path.joints_at(6, 0)[3];
  EXPECT_NEAR(std::abs(path.from(6, 0).free - begin), std::numbers::pi, 0.03);
}

TEST(PoleTravel, SeesAJointThatIsOutsideTravelForAMillimetreAlone) {
  const auto lean = [](double u) { return Lean{u == 40 ? 0.5 : 0.2, 0.1}; };
  Followed path(lean);
  ASSERT_TRUE(path.from(2, 0).keeps_travel);
  path.model.joints[4].limits.travel_min = -0.4;
  path.model.joints[4].limits.travel_max = 0.4;
  EXPECT_FALSE(path.from(2, 0).keeps_travel);
  EXPECT_TRUE(path.from(42, 0).keeps_travel) << "behind it";
  path.pass.known_end = 38;
  EXPECT_TRUE(path.from(2, 0).keeps_travel) << "ahead of it";
}

TEST(PoleTravel, ASlideOutsideTravelCountsAsWell) {
  Followed path(round);
  ASSERT_TRUE(path.from(2, 0).keeps_travel);
  path.model.joints[0].limits.travel_max = -1e9;
  EXPECT_FALSE(path.from(2, 0).keeps_travel);
}

}  // namespace
}  // namespace meridian::test::pole_travel
