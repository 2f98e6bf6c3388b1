// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "service/core/planner/feed/solver/parabola.hpp"
#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::feed_sample {
namespace {

constexpr double kFree = 1e12;  // a limit that never binds

/// A path and the joints at its begin; every limit far away.
struct Sampled {
  explicit Sampled(const MachineModel& m)
      : model(m), limits(even_limits(limited_count(m), kFree, kFree, kFree)) {}
  CellSample at(double x, double feed_share = 1) {
    JointVector reference = start;
    CellSample out;
    fault = take_sample(model, limits, feed_share, span, x, reference, out);
    joints = reference;
    return out;
  }

  MachineModel model;
  FeedLimits limits;
  FeedSpan span;
  JointVector start{}, joints{};
  PathFault fault;
};

ToolPose pose_of(double x, double tilt, double azimuth) {
  return {{x, 10, -20},
          {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)}};
}

/// A straight cut of 30 mm whose axis turns, well off the pole.
Sampled on_line(const MachineModel& model) {
  Sampled out(model);
  const ToolPose begin = pose_of(0, 0.3, 0.4), end = pose_of(30, 0.5, 1.0);
  out.span.path = make_line(begin, end);
  out.span.path.tool_length_mm = model.tool_length_mm;
  out.span.length = out.span.path.length;
  out.start = solve(model, model.tool_length_mm, begin, 0, JointVector{}).q;
  return out;
}

/// The same way of tip and axis as a spline: both linear in u over 40 mm.
Sampled on_spline(const MachineModel& model) {
  Sampled out = on_line(model);
  out.span.path.kind = PathKind::kSpline;
  out.span.path.length = out.span.length = 40;
  const ToolPose begin = pose_of(0, 0.3, 0.4), end = pose_of(30, 0.5, 1.0);
  for (std::size_t i = 0; i < 3; ++i) {
    out.span.path.spline[i] = {begin.tip[i], (end.tip[i] - begin.tip[i]) / 40};
    out.span.path.spline[i + 3] = {begin.axis[i], (end.axis[i] - begin.axis[i]) / 40};
  }
  return out;
}

TEST(FeedSample, HasTheDerivativesOfJointsAndDrives) {
  for (const MachineModel& model : {lai_machine(), hybrid_machine()}) {
    for (Sampled path : {on_line(model), on_spline(model)}) {
      constexpr double kX = 12, kStep = 0.05;
      const CellSample got = path.at(kX);
      ASSERT_FALSE(is_fault(path.fault));
      std::array<LimitedVector, 5> q;
      for (int n = 0; n < 5; ++n) {
        const double x = kX + (n - 2) * kStep;
        const auto at = joints_at(model, path.span.path, x, path.start);
        q[n] = limited_of(model, at.q);
        if (n == 2) {
          EXPECT_EQ(path.joints, at.q);
        }
      }
      for (int i = 0; i < limited_count(model); ++i) {
        EXPECT_NEAR(got.d1[i], (q[0][i] - 8 * q[1][i] + 8 * q[3][i] - q[4][i]) / (12 * kStep),
                    1e-7);
        EXPECT_NEAR(got.d2[i], (q[1][i] - 2 * q[2][i] + q[3][i]) / (kStep * kStep), 1e-6);
        EXPECT_NEAR(got.d3[i],
                    (q[4][i] - 2 * q[3][i] + 2 * q[1][i] - q[0][i]) / (2 * kStep * kStep * kStep),
                    1e-5);
      }
    }
  }
}

TEST(FeedSample, KeepsTheFeedOfTheTip) {
  Sampled line = on_line(lai_machine());
  line.span.feed_mm_per_s = 10;
  const double rate = 30 / line.span.path.length;  // of the tip, by u
  EXPECT_NEAR(line.at(5).max_b, square(10 / rate), 1e-9);
  EXPECT_NEAR(line.at(5, 0.9).max_b, square(9 / rate), 1e-9);
  Sampled spline = on_spline(lai_machine());
  spline.span.feed_mm_per_s = 10;
  EXPECT_NEAR(spline.at(5, 0.9).max_b, square(9 / 0.75), 1e-9);
}

TEST(FeedSample, KeepsTheSpeedOfThePathParameter) {
  Sampled line = on_line(lai_machine());
  line.span.u_speed_mm_per_s = 8;
  EXPECT_NEAR(line.at(5).max_b, 64, 1e-9);
  EXPECT_NEAR(line.at(5, 0.5).max_b, 16, 1e-9);
}

TEST(FeedSample, KeepsTheTurnOfTheAxis) {
  Sampled line = on_line(lai_machine());
  line.span.turn_rad_per_s = 0.2;
  const double rate = line.span.path.axis_turn / line.span.path.length;
  EXPECT_NEAR(line.at(5).max_b, square(0.2 / rate), 1e-9);
  EXPECT_NEAR(line.at(5, 0.5).max_b, square(0.1 / rate), 1e-9);
  // On a spline the turn is that of the unit axis.
  Sampled spline = on_spline(lai_machine());
  spline.span.turn_rad_per_s = 0.2;
  const Vector3 a = pose_at(spline.span.path, 4.999).axis,
                b = pose_at(spline.span.path, 5.001).axis;
  EXPECT_NEAR(spline.at(5).max_b, square(0.2 * 0.002 / angle_between(a, b)), 1e-3);
}

/// On a driven spline the axis is where the joints put it.
TEST(FeedSample, KeepsTheTurnOfTheAxisThatADrivenJointGivesIt) {
  Sampled spline = on_spline(lai_machine());
  spline.span.turn_rad_per_s = 0.2;
  spline.span.path.is_free_driven = true;
  const double free = spline.start[3];
  for (int n = 0; n < 6; ++n) spline.span.path.free_quintic[n] = free + 0.3 * n;
  const CellSample got = spline.at(5);
  ASSERT_FALSE(is_fault(spline.fault));
  const auto axis_at = [&](double x) {
    const auto q = joints_at(spline.model, spline.span.path, x, spline.start).q;
    return forward(spline.model, spline.span.path.tool_length_mm, q).axis;
  };
  const double turn = angle_between(axis_at(4.999), axis_at(5.001)) / 0.002;
  EXPECT_NEAR(got.max_b, square(0.2 / turn), 1e-3 * got.max_b);
}

TEST(FeedSample, KeepsVelocityAndWhatCurvatureTakesOfAccelerationAndJerk) {
  for (int i = 0; i < 5; ++i) {
    Sampled line = on_line(lai_machine());
    const CellSample free = line.at(12);
    line.limits.velocity[i] = 0.7;
    EXPECT_NEAR(line.at(12).max_b, square(0.7 / std::abs(free.d1[i])), 1e-9);
    line.limits.velocity[i] = kFree;
    line.limits.acceleration[i] = 0.02;
    EXPECT_NEAR(line.at(12).max_b, 4 * 0.02 / std::abs(free.d2[i]), 1e-9);
    line.limits.acceleration[i] = kFree;
    line.limits.jerk[i] = 0.001;
    EXPECT_NEAR(line.at(12).max_b, 4 * std::pow(0.001 / std::abs(free.d3[i]), 2.0 / 3), 1e-9);
  }
}

TEST(FeedSample, KeepsTheLimitsOfTheDrivesOfAStage) {
  Sampled line = on_line(hybrid_machine());
  const CellSample free = line.at(12);
  line.limits.velocity[6] = 0.7;
  EXPECT_NEAR(line.at(12).max_b, square(0.7 / std::abs(free.d1[6])), 1e-9);
}

TEST(FeedSample, IsUnreachableWhereNoJointsPutTheTool) {
  MachineModel model = lai_machine();
  Sampled line = on_line(model);
  line.span.path = make_line(pose_of(0, 0.3, 0), pose_of(5, 3.0, 0));
  line.span.path.tool_length_mm = model.tool_length_mm;
  line.model.family = MachineFamily::kRobot;  // no arm is set
  (void)line.at(1);
  EXPECT_EQ(line.fault.kind, PathFault::Kind::kUnreachable);
}

TEST(FeedSample, TakesTheTimeOfWhatIsSlowest) {
  FeedLimits limits = even_limits(2, 1e9, 1e9, 1e9);
  CellSample at;
  at.max_b = 16;
  EXPECT_DOUBLE_EQ(time_per_u(limits, at), 0.25);
  at.d1 = {0, -2};
  limits.velocity[1] = 4;
  EXPECT_DOUBLE_EQ(time_per_u(limits, at), 0.5);
  at.d2 = {-8, 0};
  limits.acceleration[0] = 2;
  EXPECT_DOUBLE_EQ(time_per_u(limits, at), 2);
  at.d3 = {0, -54};
  limits.jerk[1] = 2;
  EXPECT_DOUBLE_EQ(time_per_u(limits, at), kCurvatureShare * 3);
}

TEST(Parabola, HasItsTopWhereItIs) {
  const auto f = [](double x) { return 7 - 3 * (x - 0.25) * (x - 0.25); };  // steps of 1
  const Parabola parabola(f(-1), f(0), f(1));
  EXPECT_DOUBLE_EQ(parabola.top(), 7);
  EXPECT_DOUBLE_EQ(parabola.bend, 6);
  EXPECT_DOUBLE_EQ(parabola.slope, 3);
  EXPECT_DOUBLE_EQ(parabola.middle, f(0));
}

}  // namespace
}  // namespace meridian::test::feed_sample
