// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/jerk_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "meridian/planner/profile.hpp"
#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::jerk_step {
namespace {

constexpr double kFree = 1e9;  // a limit that never binds

/// u̇ where the motion of `profile` has come to `s`, and twice its acceleration there.
FeedState state_on(const Profile& profile, double length, double s) {
  const ProfilePhases phases = phases_of(profile, length);
  FeedState out;
  for (int n = 0; n < phases.count; ++n) {
    const ProfilePhase& p = phases.phase[n];
    for (int k = 0; k <= 20000; ++k) {
      const double t = p.duration * k / 20000;
      const double at = p.s + t * (p.v + t * (p.a / 2 + t * p.j / 6));
      if (at > s) return out;
      const double v = p.v + t * (p.a + t * p.j / 2);
      out = {v * v, 2 * (p.a + t * p.j)};
    }
  }
  return out;
}

TEST(JerkStep, RunsAtTheLargestFeedWhereNothingElseBinds) {
  MadeCells cells(40, 0.5, 100);
  JerkStep step(cells.grid, even_limits(1, kFree, kFree, kFree), 40);
  ASSERT_TRUE(step.solve(MadeProblem(40, 90).between({80, 0}, {70, 0})));
  for (int k = 0; k <= 40; ++k) EXPECT_LE(step.b(k), 100 * (1 + 1e-6)) << k;
  for (int k = 0; k < 40; ++k) EXPECT_LE(step.middle(k), 100 * (1 + 1e-6)) << k;
  for (int k = 4; k <= 36; ++k) EXPECT_NEAR(step.b(k), 100, 0.4) << k;
  EXPECT_LE(step.rounds(), 12);
}

TEST(JerkStep, KeepsAFeedThatIsLowInOneCell) {
  MadeCells cells(40, 0.5, 100);
  cells.grid[17].max_b = 60;
  JerkStep step(cells.grid, even_limits(1, kFree, kFree, kFree), 40);
  ASSERT_TRUE(step.solve(MadeProblem(40, 90).between({80, 0}, {80, 0})));
  EXPECT_LE(step.b(17), 60 * (1 + 1e-6));
  EXPECT_LE(step.middle(17), 60 * (1 + 1e-6));
  EXPECT_LE(step.b(18), 60 * (1 + 1e-6));
  EXPECT_NEAR(step.middle(17), 60, 0.5);
  EXPECT_GT(step.b(15), 90);
  EXPECT_GT(step.b(20), 90);
}

TEST(JerkStep, AcceleratesAndBrakesAtTheLimitOfAcceleration) {
  MadeCells cells(60, 0.2, 1e4);
  JerkStep step(cells.grid, even_limits(1, kFree, 50, kFree), 60);
  ASSERT_TRUE(step.solve(MadeProblem(60, 300).between({100, 0}, {100, 0})));
  // b' is 2 A but in the first and the last cell, where it grows from 0.
  for (int k = 2; k <= 28; ++k) {
    EXPECT_NEAR(step.b(k), 100 + 100 * (0.2 * k - 0.1), 1) << k;
    EXPECT_NEAR(step.slope(k), 100, 1) << k;
    EXPECT_NEAR(step.b(60 - k), step.b(k), 1) << k;
    EXPECT_NEAR(step.slope(60 - k), -100, 1) << k;
  }
  EXPECT_LE(step.rounds(), 16);
}

TEST(JerkStep, FindsTheSevenPhasesThatAreTheFastest) {
  constexpr double kLength = 20;
  constexpr int kCells = 80;
  const Profile best = rest_to_rest(kLength, {100, 1000, 20000});
  MadeCells cells(kCells, 18.0 / kCells, 100 * 100);
  JerkStep step(cells.grid, even_limits(1, 100, 1000, 20000), kCells);
  MadeProblem problem(kCells, 1);
  const auto b_at = [&](double x) { return state_on(best, kLength, 1 + x).b; };
  for (int k = 0; k <= kCells; ++k) problem.bar_knots[k] = 0.8 * b_at(18.0 * k / kCells);
  for (int k = 0; k < kCells; ++k) problem.bar_middles[k] = 0.8 * b_at(18.0 * (k + 0.5) / kCells);
  const FeedState begin = state_on(best, kLength, 1);
  for (int round = 0; round < 4; ++round) {
    ASSERT_TRUE(step.solve(problem.between(begin, {begin.b, -begin.slope}))) << round;
    EXPECT_LE(step.rounds(), 20) << round;
    problem.linearise_at(step);
  }
  for (int k = 0; k <= kCells; k += 4) {
    const double b = b_at(18.0 * k / kCells);
    EXPECT_NEAR(step.b(k), b, 0.01 * b) << k;
  }
}

TEST(JerkStep, BeginsAndEndsAsItIsToldTo) {
  MadeCells cells(40);
  cells.grid[0].h = 0.3;
  cells.grid[39].h = 0.4;
  JerkStep step(cells.grid, even_limits(1, kFree, 500, 5e4), 40);
  ASSERT_TRUE(step.solve(MadeProblem(40, 300).between({90, 12}, {110, -17})));
  EXPECT_NEAR(step.b(0), 90, 1e-9);
  EXPECT_NEAR(step.slope(0), 12, 1e-9);
  EXPECT_NEAR(step.b(40), 110, 1e-9);
  EXPECT_NEAR(step.slope(40), -17, 1e-9);
}

/// Cells of drawn lengths in which three quantities bend as they like.
void draw_cells(CellGrid& grid, unsigned seed) {
  std::mt19937 random(seed);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  double h = 0.3;
  for (std::int64_t k = grid.first(); k < grid.last(); ++k) {
    h = std::clamp(h * real(0.7, 1.4), 0.1, 0.6);
    grid[k].h = h;
    grid[k].max_b = real(60, 120);
    const auto x = static_cast<double>(k);
    for (int n = 0; n <= FeedCell::kSteps; ++n) {
      CellSample& at = grid[k].at[n];
      at.d1 = {0.8 + 0.2 * std::sin(0.3 * x), std::cos(0.2 * x), -0.5};
      at.d2 = {0.3 * std::cos(0.3 * x), -0.2 * std::sin(0.4 * x), 0.1};
      at.d3 = {0.02, 0.05 * std::cos(0.1 * x), -0.03 * std::sin(0.2 * x)};
    }
  }
}

/// The largest shares of acceleration, jerk and feed that the plan of `step` uses.
struct Use {
  double acceleration = 0, jerk = 0, feed = 0;
};
Use use_of(const CellGrid& grid, const FeedLimits& limits, const MadeProblem& problem,
           const JerkStep& step, int cells) {
  Use use;
  for (int k = 0; k < cells; ++k) {
    const double h = grid[k].h, bend = (step.slope(k + 1) - step.slope(k)) / h;
    for (int third = 0; third <= 2; ++third) {
      const CellSample& at = grid[k].at[third * FeedCell::kSteps / 2];
      const double x = 0.5 * third * h;
      const double b = step.b(k) + x * (step.slope(k) + 0.5 * x * bend), v = std::sqrt(b);
      const double slope = step.slope(k) + x * bend;
      if (third > 0) use.feed = std::max(use.feed, b / grid[k].max_b);
      for (int j = 0; j < limits.count; ++j) {
        const double jerk = (at.d3[j] * b + 1.5 * at.d2[j] * slope + 0.5 * at.d1[j] * bend) * v;
        const double accel =
            std::abs(0.5 * at.d1[j] * slope + at.d2[j] * b) + limits.slope * std::abs(at.d1[j]) * v;
        use.jerk = std::max(use.jerk, std::abs(jerk) / (limits.jerk[j] * problem.jerk_share[k]));
        if (k > 0 && third == 0) {
          use.acceleration =
              std::max(use.acceleration, accel / (limits.acceleration[j] * problem.accel_share[k]));
        }
      }
    }
  }
  return use;
}

double time_of(const CellGrid& grid, const JerkStep& step, int cells) {
  double time = 0;
  for (int k = 0; k < cells; ++k) time += grid[k].h / std::sqrt(step.middle(k));
  return time;
}

TEST(JerkStep, KeepsEveryLimitOfEveryJointAndUsesThemUp) {
  constexpr int kCells = 60;
  MadeCells cells(kCells);
  draw_cells(cells.grid, 3);
  FeedLimits limits = even_limits(3, kFree, 45, 900);
  limits.slope = 0.5;
  JerkStep step(cells.grid, limits, kCells);
  MadeProblem problem(kCells, 40);
  for (int k = 0; k <= kCells; ++k) {
    problem.accel_share[k] = 1 - 0.003 * k;
    problem.jerk_share[k] = 1 - 0.005 * k;
  }
  double before = 1e300;
  for (int round = 0; round < 5; ++round) {
    ASSERT_TRUE(step.solve(problem.between({30, 0}, {25, 0})));
    EXPECT_LE(step.rounds(), 20) << round;
    const Use use = use_of(cells.grid, limits, problem, step, kCells);
    EXPECT_LE(use.acceleration, 1 + 1e-5) << round;
    EXPECT_LE(use.jerk, 1 + 1e-5) << round;
    EXPECT_LE(use.feed, 1 + 1e-5) << round;
    const double time = time_of(cells.grid, step, kCells);
    EXPECT_LE(time, before * (1 + 1e-4)) << "linearised at a plan it is no slower, round " << round;
    before = time;
    problem.linearise_at(step);
  }
  const Use use = use_of(cells.grid, limits, problem, step, kCells);
  EXPECT_GT(use.acceleration, 0.999);
  EXPECT_GT(use.jerk, 0.999);
  EXPECT_GT(use.feed, 0.999);
}

TEST(JerkStep, GivesAQuadraticInEveryCell) {
  MadeCells cells(40);
  draw_cells(cells.grid, 4);
  JerkStep step(cells.grid, even_limits(3, kFree, 60, 900), 40);
  ASSERT_TRUE(step.solve(MadeProblem(40, 40).between({30, 2}, {25, -3})));
  for (int k = 0; k < 40; ++k) {
    const double h = cells.grid[k].h;
    EXPECT_NEAR(step.b(k + 1), step.b(k) + 0.5 * h * (step.slope(k) + step.slope(k + 1)), 1e-9);
    EXPECT_NEAR(step.middle(k), step.b(k) + h * (3 * step.slope(k) + step.slope(k + 1)) / 8, 1e-9);
  }
}

/// The plan as numbers, to compare bit for bit.
std::vector<double> plan_of(JerkStep& step, const JerkProblem& problem) {
  std::vector<double> out{step.solve(problem) ? 1.0 : 0.0, 1.0 * step.rounds()};
  for (int k = 0; k <= problem.cells; ++k) out.insert(out.end(), {step.b(k), step.slope(k)});
  for (int k = 0; k < problem.cells; ++k) out.push_back(step.middle(k));
  return out;
}

TEST(JerkStep, GivesTheSameBitsForTheSameProblemWhateverWasSolvedBefore) {
  MadeCells cells(60);
  draw_cells(cells.grid, 5);
  JerkStep step(cells.grid, even_limits(3, kFree, 60, 900), 60);
  const MadeProblem problem(40, 40), other(60, 30);
  const auto first = plan_of(step, problem.between({30, 0}, {25, 0}));
  (void)step.solve(other.between({5, 0}, {5, 0}));
  EXPECT_EQ(plan_of(step, problem.between({30, 0}, {25, 0})), first);
}

TEST(JerkStep, SeesTheCellsOfItsWindowAlone) {
  MadeCells whole(60), part(45);
  draw_cells(whole.grid, 6);
  for (int k = 0; k < 45; ++k) part.grid[k] = whole.grid[k + 15];
  const FeedLimits limits = even_limits(3, kFree, 60, 900);
  JerkStep in_whole(whole.grid, limits, 45), in_part(part.grid, limits, 45);
  const MadeProblem problem(45, 40);
  EXPECT_EQ(plan_of(in_whole, problem.between({30, 0}, {25, 0}, 15)),
            plan_of(in_part, problem.between({30, 0}, {25, 0})));
}

TEST(JerkStep, TakesSharesOfAccelerationAndJerkAsLowerLimits) {
  MadeCells cells(40);
  draw_cells(cells.grid, 7);
  MadeProblem problem(40, 40), halved(40, 40);
  for (double& share : halved.accel_share) share = 0.5;
  for (double& share : halved.jerk_share) share = 0.25;
  JerkStep step(cells.grid, even_limits(3, kFree, 80, 4000), 40);
  JerkStep tight(cells.grid, even_limits(3, kFree, 40, 1000), 40);
  EXPECT_EQ(plan_of(step, halved.between({30, 0}, {25, 0})),
            plan_of(tight, problem.between({30, 0}, {25, 0})));
}

TEST(JerkStep, FindsNoPlanWhereTheBrakesAreTooWeak) {
  MadeCells cells(40, 0.1, 1e4);
  JerkStep step(cells.grid, even_limits(1, kFree, 100, kFree), 40);
  // 4 mm at 100 mm/s² take 800 off u̇².
  EXPECT_FALSE(step.solve(MadeProblem(40, 500).between({1000, 0}, {100, 0})));
  EXPECT_LT(step.rounds(), JerkStep::kRounds) << "it sees that there is none";
  EXPECT_TRUE(step.solve(MadeProblem(40, 500).between({1000, 0}, {300, 0})));
}

}  // namespace
}  // namespace meridian::test::jerk_step
