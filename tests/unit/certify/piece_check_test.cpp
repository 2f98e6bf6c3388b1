// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/piece_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "meridian/path/build_piece.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "service/core/planner/feed/solver/feed_check.hpp"
#include "support/machines.hpp"

namespace meridian::certify {
namespace {

constexpr auto kVelocity = static_cast<std::size_t>(Quantity::kVelocity);
constexpr int kC = 3;

[[nodiscard]] PathPiece line(const MachineModel& model, const ToolPose& begin,
                             const ToolPose& end) {
  PathPiece path = make_line(begin, end);
  path.tool_length_mm = model.tool_length_mm;
  path.joints_begin = joints_at(model, path, 0.0, JointVector{}).q;
  path.joints_end = joints_at(model, path, path.length, path.joints_begin).q;
  return path;
}

/// 10 mm aside with the axis upright but for a tilt.
[[nodiscard]] PathPiece plain_line(const MachineModel& model) {
  const Vector3 axis(std::sin(0.3), 0, std::cos(0.3));
  return line(model, {Vector3(10, 20, 5), axis}, {Vector3(20, 20, 5), axis});
}

[[nodiscard]] TimePiece along(double duration, double v) {
  TimePiece piece;
  piece.duration = duration;
  piece.v = v;
  return piece;
}

/// The tilt goes through zero between the samples 4 and 5 of nine, `beside` rad beside the pole.
[[nodiscard]] PathPiece past_the_pole(const MachineModel& model, double beside) {
  constexpr double kBehind = 0.01 * 4.5 / 4, kAhead = 0.01 * 3.5 / 4;
  const auto axis = [beside](double tilt) {
    return Vector3(std::sin(tilt), beside, std::cos(tilt)).normalized();
  };
  return line(model, {Vector3(10, 0, 0), axis(-kBehind)}, {Vector3(10, 0, 0), axis(kAhead)});
}

/// What the planner's check of a cell makes of the whole of `path` at an even speed.
[[nodiscard]] FeedUse sampled_use(const MachineModel& model, const PathPiece& path, double v) {
  FeedCell cell;
  cell.h = path.length;
  JointVector joints = path.joints_begin;
  for (int n = 0; n <= FeedCell::kSteps; ++n) {
    CellSample& at = cell.at[static_cast<std::size_t>(n)];
    const double s = path.length * n / FeedCell::kSteps;
    const auto solution = joints_at(model, path, Jet<3>::variable(s), joints);
    for (std::size_t i = 0; i < 5; ++i) {
      joints[i] = solution.q[i].value();
      at.d1[i] = solution.q[i].derivative(1);
      at.d2[i] = solution.q[i].derivative(2);
      at.d3[i] = solution.q[i].derivative(3);
    }
    at.max_b = 1e9;
  }
  return use_of(make_feed_limits(model, {0, 0}), cell, {v * v, 0, 0});
}

TEST(PieceCheck, RefutesAPeakBetweenNineSamplesThatTheSampledCheckAccepts) {
  const MachineModel model = test::bench_machine();
  const PathPiece path = past_the_pole(model, 3e-6);
  const double v = path.length;  // 1 s
  EXPECT_LT(sampled_use(model, path, v).worst(), 1);
  const PieceVerdict verdict = PieceCheck(model).check(along(1, v), path);
  EXPECT_EQ(verdict.status, Status::kRefuted);
  EXPECT_EQ(verdict.worst.joint, kC);
  EXPECT_GT(verdict.worst.share, 10);
  EXPECT_NEAR(verdict.worst.time_s, 4.5 / 8, 0.01);
}

TEST(PieceCheck, CertifiesTheSamePassageAtASpeedThatThePeakAllows) {
  const MachineModel model = test::bench_machine();
  const PathPiece path = past_the_pole(model, 1e-3);
  const double slow = path.length / 60;  // C at 0.02 rad/60 s / 1e-3
  const PieceVerdict verdict = PieceCheck(model).check(along(60, slow), path);
  EXPECT_EQ(verdict.status, Status::kCertified);
  const double peak = 0.02 / 60 / 1e-3 / model.joints[kC].limits.velocity;
  EXPECT_NEAR(verdict.bound[kVelocity].share, peak, 0.05 * peak);
  EXPECT_GE(verdict.bound[kVelocity].share, peak * (1 - 1e-4));
}

/// About the middle of the piece C is as t⁶: every coefficient there but the last is zero.
TEST(PieceCheck, BoundsWhatTheCoefficientsInTheMiddleDoNotShow) {
  const MachineModel model = test::bench_machine();
  PathPiece path;
  path.kind = PathKind::kSpline;
  path.is_free_driven = true;
  path.length = 2;
  path.tool_length_mm = model.tool_length_mm;
  path.spline[0][0] = 50;
  path.spline[5][0] = 1;
  for (int n = 0; n < 6; ++n) {  // 0.08 (x - 1/2)³ of x in [0, 1], in Bernstein form
    const double square = n * (n - 1) / 20.0, cube = n * (n - 1) * (n - 2) / 60.0;
    path.free_quintic[static_cast<std::size_t>(n)] =
        0.08 * (cube - 1.5 * square + 0.75 * n / 5 - 0.125);
  }
  TimePiece piece = along(0.2, -10);  // down to s = 1, the middle, and up again
  piece.s0 = 1.5;
  piece.a = 100;
  const PieceVerdict verdict = PieceCheck(model).check(piece, path);
  for (int n = 0; n <= 1000; ++n) {
    const PathState p = state_at(piece, piece.duration * n / 1000);
    const auto at =
        joints_at(model, path, Jet<3>::from_derivatives({p.s, p.ds, p.dds, p.ddds}), JointVector{});
    for (std::size_t i = 0; i < 5; ++i) {
      const JointLimits& limits = model.joints[i].limits;
      for (int order = 1; order <= 3; ++order) {
        const double limit = order == 1   ? limits.velocity
                             : order == 2 ? limits.acceleration
                                          : limits.jerk;
        const double share = std::abs(at.q[i].derivative(order)) / limit;
        EXPECT_LE(share, verdict.joint_bound[i][static_cast<std::size_t>(order) - 1] + 1e-12)
            << "joint " << i << ", order " << order << ", instant " << n;
      }
    }
  }
  EXPECT_GT(verdict.joint_bound[kC][2], 0.5);
}

TEST(PieceCheck, HoldsTheTipAgainstTheFeedTimesItsFactor) {
  const MachineModel model = test::bench_machine();
  const PathPiece path = plain_line(model);
  TimePiece piece = along(0.2, 50);
  piece.feed_mm_per_s = 49;
  EXPECT_EQ(PieceCheck(model).check(piece, path).worst.quantity, Quantity::kFeed);
  piece.feed_factor = 1.03;
  EXPECT_EQ(PieceCheck(model).check(piece, path).status, Status::kCertified);
  piece.feed_mm_per_s = 0;  // a rapid
  piece.feed_factor = 1;
  EXPECT_EQ(PieceCheck(model).check(piece, path).status, Status::kCertified);
}

TEST(PieceCheck, ChecksTheDrivesOfAStageToo) {
  MachineModel model = test::hybrid_machine();
  const Vector3 axis(std::sin(0.3), 0, std::cos(0.3));
  const PathPiece path =
      line(model, {Vector3(10, 20, 5), axis},
           {Vector3(10, 20, 5),
            Vector3(std::sin(0.3) * std::cos(0.4), std::sin(0.3) * std::sin(0.4), std::cos(0.3))});
  const TimePiece piece = along(1, path.length);
  EXPECT_EQ(PieceCheck(model).check(piece, path).status, Status::kCertified);
  model.stage_drives[1].limits.acceleration = 1;
  const PieceVerdict verdict = PieceCheck(model).check(piece, path);
  EXPECT_EQ(verdict.status, Status::kRefuted);
  EXPECT_EQ(verdict.worst.joint, 6);
}

TEST(PieceCheck, KnowsThatTheRedundantJointRestsWhereItIsHeldOnThePole) {
  const MachineModel model = test::bench_machine();
  const Vector3 up(0, 0, 1);
  const PathPiece path = line(model, {Vector3(10, 20, 5), up}, {Vector3(20, 20, 5), up});
  const PieceVerdict verdict = PieceCheck(model).check(along(0.2, 50), path);
  EXPECT_EQ(verdict.status, Status::kCertified);
  EXPECT_LT(verdict.joint_bound[kC][0], 1e-200);
}

TEST(PieceCheck, LeavesUndecidedWhatComesOutOfTheHold) {
  const MachineModel model = test::bench_machine();
  const PathPiece path =
      line(model, {Vector3(10, 20, 5), Vector3(0, 0, 1)},
           {Vector3(10, 20, 5), Vector3(std::sin(0.1), 0.01, std::cos(0.1)).normalized()});
  TimePiece piece = along(1, 0);
  piece.a = 2 * path.length;
  EXPECT_EQ(PieceCheck(model).check(piece, path).status, Status::kUndecided);
}

TEST(PieceCheck, CertifiesMovesOfTheJointsAndTurnsOnThePole) {
  const MachineModel model = test::bench_machine();
  const PathPiece joints = make_joint_move(JointVector{}, {10, 20, 30, 0.2, 0.1}, 0b11000);
  EXPECT_EQ(PieceCheck(model).check(along(1, joints.length), joints).status, Status::kCertified);
  EXPECT_EQ(PieceCheck(model).check(along(0.05, 20 * joints.length), joints).status,
            Status::kRefuted);
  PathPiece turn = make_turn({Vector3(10, 0, 0), Vector3(0, 0, 1)}, 0, 0.5);
  turn.tool_length_mm = model.tool_length_mm;
  const PieceVerdict verdict = PieceCheck(model).check(along(1, turn.length), turn);
  EXPECT_EQ(verdict.status, Status::kCertified);
  EXPECT_NEAR(verdict.joint_bound[kC][0], 0.5 / model.joints[kC].limits.velocity, 1e-9);
}

}  // namespace
}  // namespace meridian::certify
