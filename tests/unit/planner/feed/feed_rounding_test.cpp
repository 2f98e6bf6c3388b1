// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/feed_sample.hpp"
#include "service/core/planner/feed/legs/path_choice.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"

namespace meridian::test::feed_rounding {
namespace {

ToolPose pose_of(double x, double tilt, double azimuth) {
  return {{x, 10, -20},
          {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)}};
}

TEST(FeedRounding, TakesJerkBesideThePoleAlone) {
  const MachineModel model = bench_machine();
  const FeedLimits limits = make_feed_limits(model, {1, 10});
  PathPiece path = make_line(pose_of(0, 2e-5, 0), pose_of(30, 0.5, 0));
  const auto share_at = [&](double x) {
    return share_beside_singularity(model, limits, path, x, {});
  };
  const ToolPose pose = pose_at(path, 0.0);
  const JointCaps caps = planned_caps(model, pose_in_machine(model, pose).tip.norm());
  double expected = 1;
  for (int i = 0; i < 5; ++i) {
    const double noise = kAxisNoise / pole_distance(model, pose.axis);
    expected = std::min(expected, 1 - caps.noise_gain[i] * noise / limits.jerk[i]);
  }
  ASSERT_GT(expected, kMinTight);
  ASSERT_LT(expected, 0.999);
  EXPECT_DOUBLE_EQ(share_at(0), expected);
  EXPECT_GT(share_at(30), 0.999);
  path.is_free_driven = true;
  EXPECT_EQ(share_at(0), 1) << "the joint is not solved for";
  path.kind = PathKind::kSpline;
  for (std::size_t i = 0; i < 3; ++i) path.spline[i + 3] = {pose.axis[i]};
  EXPECT_LT(share_at(0), 0.999) << "the tilt follows the axis";
  path.kind = PathKind::kJoint;
  EXPECT_EQ(share_at(0), 1);
  path = make_line(pose_of(0, 1e-7, 0), pose_of(30, 0.5, 0));
  EXPECT_EQ(share_at(0), kMinTight);
}

MachineModel robot_with_limits(double origin_mm) {
  MachineModel model = robot_machine(true);
  for (JointSpec& joint : model.joints) joint.limits = {-3, 3, 1.5, 6, 60};
  model.X_MW.origin_mm = {origin_mm, 0.2 * origin_mm, 250};
  return model;
}

/// A 6R robot whose wrist point is `beside_mm` from the base axis, with that bend, and a path of
/// 1 mm that moves tip and axis from there.
struct Beside {
  Beside(double beside_mm, double bend_rad, double origin_mm = 0)
      : model(robot_with_limits(origin_mm)) {
    const RobotKinematics& robot = model.robot;
    const double shoulder = 1.9;
    const double across = (beside_mm - robot.upper_arm_mm * std::cos(shoulder)) / robot.forearm_mm;
    joints = {0.7, shoulder, -std::acos(across) - shoulder, 0.4, bend_rad, 0};
    const ToolPose from = forward(model, model.tool_length_mm, joints);
    path = make_line(from, {from.tip + Vector3(0.4, 0.5, -0.7), from.axis});
    path.tool_length_mm = model.tool_length_mm;
    path.branch = bend_rad > 0 ? 0 : robot::kFlip;
  }
  [[nodiscard]] double share() const {
    return share_beside_singularity(model, make_feed_limits(model, {1, 10}), path, 0, joints);
  }
  /// The largest third difference of yaw and roll over setpoints so close that it is rounding, over
  /// their jerk.
  [[nodiscard]] double shown() const {
    std::array<JointVector, 4> last{};
    double largest = 0;
    for (int n = 0; n < 4000; ++n) {
      std::rotate(last.begin(), last.begin() + 1, last.end());
      last[3] = solve(model, path.tool_length_mm, pose_at(path, 1e-9 * n), path.branch, joints).q;
      if (n < 3) continue;
      for (const int i : {0, 3}) {
        const double third = last[3][i] - 3 * last[2][i] + 3 * last[1][i] - last[0][i];
        largest = std::max(largest, std::abs(third) * 1e9 / model.joints[i].limits.jerk);
      }
    }
    return largest;
  }

  MachineModel model;
  JointVector joints{};
  PathPiece path;
};

TEST(FeedRounding, LeavesARobotRoomForWhatYawAndRollShowBesideBothSingularities) {
  int compared = 0;
  for (const double beside_mm : {0.012, 0.03, 1.0}) {
    for (const double bend_rad : {0.002, -0.002, 0.01, 0.3}) {
      for (const double origin_mm : {0.0, 850.0}) {
        SCOPED_TRACE(testing::Message() << beside_mm << " mm, " << bend_rad << ", " << origin_mm);
        const Beside beside(beside_mm, bend_rad, origin_mm);
        const double room = 1 - beside.share();
        if (room == 1 - kMinTight) continue;
        ++compared;
        EXPECT_LT(beside.shown(), room);
        EXPECT_LT(room, 15 * beside.shown()) << "not much more than that";
      }
    }
  }
  EXPECT_GT(compared, 15);
  EXPECT_GT(Beside(0.012, 0.002).shown(), 0.01);
}

TEST(FeedRounding, TakesNothingForJointsOfARobotThatAreDriven) {
  Beside beside(0.012, 0.002);
  beside.path.is_free_driven = true;
  beside.path.branch = robot::kYawDriven;
  EXPECT_GT(beside.share(), 1 - 1e-4) << "the roll's own rounding stays";
  EXPECT_LT(beside.share(), 1);
  beside.path.branch = robot::kYawAndRollDriven;
  EXPECT_EQ(beside.share(), 1);
  beside.path.branch = 0;  // the roll
  const double by_yaw = beside.share();
  EXPECT_LT(by_yaw, 1);
  EXPECT_GT(by_yaw, 0.99);
  beside.path.kind = PathKind::kJoint;
  EXPECT_EQ(beside.share(), 1);
}

TEST(FeedRounding, NeverTakesAllOfTheJerk) {
  EXPECT_EQ(Beside(1e-4, 1e-4).share(), kMinTight);
  EXPECT_GT(Beside(1e-12, 0.3).share(), 1 - 1e-6) << "the yaw is held, not solved for";
}

}  // namespace
}  // namespace meridian::test::feed_rounding
