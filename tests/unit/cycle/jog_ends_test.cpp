// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "meridian/cycle/jog/jogging.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "unit/cycle/hand.hpp"

/// The tool jogged from the ends of travel, from outside of it, and from the pole: it moves on its
/// line or not at all, never farther out, and always to where there is room.
namespace meridian {
namespace {

using test::Hand;

constexpr int kX = kMaxJoints, kZ = kMaxJoints + 2, kTiltX = kMaxJoints + 3,
              kTiltY = kMaxJoints + 4;
constexpr double kOnLine = 1e-8, kOnAxis = 1e-10, kGuarded = 1e-9;

/// How far outside of travel `joints` are, at most.
[[nodiscard]] double outside(const MachineModel& machine, const JointVector& joints) {
  double max = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    if (machine.joints[i].is_endless) continue;
    const JointLimits& limits = machine.joints[i].limits;
    max = std::max({max, limits.travel_min - joints[i], joints[i] - limits.travel_max});
  }
  return max;
}

/// A hand on the tool, and how it did.
struct ToolHand {
  explicit ToolHand(const JointVector& at) : hand(test::lai_machine(), at), begin(pose()) {}

  /// Holds `velocity` for so long; how far the tool went, in mm or rad. What is wrong is reported.
  double hold(int axis, double velocity, double seconds = 1.0) {
    const bool is_held = hand.world.now() != State::kReady || hand.lay_on(axis);
    EXPECT_TRUE(is_held);
    const ToolPose from = pose();
    const std::size_t first = hand.world.records.size();
    double out_before = outside(hand.world.machine, hand.world.state.joints);
    hand.hold(axis, velocity, seconds);
    for (std::size_t n = first; n < hand.world.records.size(); ++n) {
      const JointVector& joints = hand.world.records[n].joints;
      const double out = outside(hand.world.machine, joints);
      EXPECT_LE(out, std::max(out_before, kGuarded)) << "farther out";
      out_before = out;
      expect_on_line(forward(hand.world.machine, hand.world.machine.tool_length_mm, joints));
    }
    EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
    const bool is_tilt = axis >= kTiltX;
    return is_tilt ? (pose().axis - from.axis).norm() : (pose().tip - from.tip).norm();
  }
  /// Lets go; the way is laid anew by the next hold.
  void let_go() {
    EXPECT_TRUE(hand.world.run_until(State::kReady, 5));
    begin = pose();
  }
  void expect_on_line(const ToolPose& is) const {
    const ToolPath& tool_path = hand.world.state.jogging.tool_path;
    const Vector3 direction = to_vector(tool_path.direction), moved = is.tip - begin.tip;
    if (tool_path.is_tilt) {
      EXPECT_LE(moved.norm(), kOnLine);
      EXPECT_LE(std::abs(is.axis.dot(begin.axis.cross(direction))), kOnAxis);
    } else {
      EXPECT_LE((moved - moved.dot(direction) * direction).norm(), kOnLine);
      EXPECT_LE((is.axis - begin.axis).norm(), kOnAxis);
    }
  }
  [[nodiscard]] ToolPose pose() const {
    return forward(hand.world.machine, hand.world.machine.tool_length_mm, hand.world.state.joints);
  }

  Hand hand;
  ToolPose begin;
};

/// Each joint at each of its ends: away from there the tool moves along one way of every axis at
/// least, and along its own axis, where the joint stands still, along both.
TEST(JogEnds, MovesTheToolFromEveryEndOfTravelToWhereThereIsRoom) {
  const MachineModel machine = test::lai_machine();
  for (int joint = 0; joint < machine.joint_count; ++joint) {
    for (const bool is_high : {false, true}) {
      JointVector at{30, -40, 50, 0.7, 0.5, 0};
      const JointLimits& limits = machine.joints[static_cast<std::size_t>(joint)].limits;
      at[static_cast<std::size_t>(joint)] = is_high ? limits.travel_max : limits.travel_min;
      for (int axis = kX; axis < kX + kToolAxisCount; ++axis) {
        SCOPED_TRACE(machine.joints[static_cast<std::size_t>(joint)].name +
                     (is_high ? " high" : " low") + ", axis " + std::to_string(axis - kX));
        const double velocity = axis >= kTiltX ? 0.2 : 20;
        ToolHand one(at), other(at);
        const double there = one.hold(axis, velocity, 0.4), back = other.hold(axis, -velocity, 0.4);
        EXPECT_GT(std::max(there, back), velocity * 0.1);
        const bool stands = axis < kTiltX && joint >= 3;  // a rotary joint, where the axis is fixed
        if (stands) {
          EXPECT_GT(std::min(there, back), velocity * 0.1);
        }
      }
    }
  }
}

TEST(JogEnds, LeadsTheToolFromOutsideOfTravelInwardsOnly) {
  for (const double beyond : {1e-6, 0.5, 12.0}) {
    SCOPED_TRACE(beyond);
    JointVector at{30, 600 + beyond, 50, 0, 0, 0};
    ToolHand tool(at);
    // On the Lai machine b2 carries W's y, or x, where the table stands at 0.
    const double x_out = tool.hold(kX + 1, 30, 0.6), x_in = tool.hold(kX + 1, -30, 0.6);
    EXPECT_GT(std::max(x_out, x_in), 5) << "there is a way in";
    EXPECT_LT(std::min(x_out, x_in), 1e-9) << "and none out";
    const double inwards = outside(tool.hand.world.machine, tool.hand.world.state.joints);
    EXPECT_LT(inwards, beyond);
    const double there = x_in > x_out ? -30 : 30;
    tool.hold(kX + 1, -there, 0.5);
    EXPECT_LE(outside(tool.hand.world.machine, tool.hand.world.state.joints), inwards + 1e-11)
        << "not out again";
    tool.hold(kX + 1, there, 2.0);
    EXPECT_LE(outside(tool.hand.world.machine, tool.hand.world.state.joints), 0);
    tool.hold(kX + 1, -there, 3.0);
    EXPECT_LE(outside(tool.hand.world.machine, tool.hand.world.state.joints), 0);
  }
}

TEST(JogEnds, MovesTheToolAlongItsAxisWhileAJointThatRestsIsOutsideOfTravel) {
  JointVector at{30, -40, 50, 0.7, test::lai_machine().joints[4].limits.travel_max + 1e-3, 0};
  ToolHand tool(at);
  EXPECT_GT(tool.hold(kZ, 20, 0.4), 2);
  EXPECT_GT(tool.hold(kZ, -20, 0.8), 2);
  EXPECT_NEAR(tool.hand.world.state.joints[4], at[4], 1e-11);
}

TEST(JogEnds, MovesTheToolThatStandsOnThePole) {
  for (int axis = kX; axis < kTiltX; ++axis) {
    for (const double velocity : {-20.0, 20.0}) {
      ToolHand tool({30, -40, 50, 0.7, 0, 0});
      EXPECT_GT(tool.hold(axis, velocity, 0.4), 2) << axis - kX;
      EXPECT_EQ(tool.hand.world.state.joints[3], 0.7) << "C stands still";
    }
  }
}

/// In the plane that the table stands in the tool leaves the pole and passes it; in another plane
/// it stands until the table is turned.
TEST(JogEnds, TiltsTheToolOffThePoleAndThroughItInThePlaneOfTheTable) {
  int sides = 0;
  for (const int axis : {kTiltX, kTiltY}) {
    for (const double velocity : {-0.2, 0.2}) {
      ToolHand tool({30, -40, 50, 0, 0, 0});
      const double off = tool.hold(axis, velocity, 0.5);
      sides += off > 0.05;
      const double tilt = tool.hand.world.state.joints[4];
      tool.hold(axis, -velocity, 1.0);
      const bool is_through = tilt * tool.hand.world.state.joints[4] < 0;
      EXPECT_EQ(is_through, off > 0.05);
      EXPECT_EQ(tool.hand.world.state.joints[3], 0) << "C stands still";
    }
  }
  EXPECT_EQ(sides, 2) << "both ways about one of the two axes";

  ToolHand askew({30, -40, 50, 0.7, 0, 0});
  EXPECT_EQ(askew.hold(kTiltX, 0.2, 0.5) + askew.hold(kTiltY, 0.2, 0.5), 0);
}

TEST(JogEnds, TiltsTheToolAwayFromBesideThePoleWhicheverWay) {
  for (const double beside : {1e-5, -1e-4, 1e-3}) {
    for (const int axis : {kTiltX, kTiltY}) {
      for (const double velocity : {-0.5, 0.5}) {
        SCOPED_TRACE(testing::Message() << beside << ", axis " << axis - kX << ", " << velocity);
        ToolHand tool({30, -40, 50, 0.7, beside, 0});
        double off = 0;
        for (int n = 0; n < 3; ++n) {
          off += tool.hold(axis, velocity, 1.0);
          tool.let_go();
        }
        EXPECT_GT(off, std::abs(beside));
      }
    }
  }
}

}  // namespace
}  // namespace meridian
