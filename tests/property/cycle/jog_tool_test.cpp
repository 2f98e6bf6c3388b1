// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "property/cycle/operated_run.hpp"
#include "support/draws.hpp"
#include "support/family_machines.hpp"
#include "unit/cycle/hand.hpp"

/// Jogging the tool keeps the limits of every joint and drive in every cycle, near the pole, at the
/// ends of travel and of an arm's reach too, and the tool stays on its way.
namespace meridian::test::jog_tool {
namespace {

using test::Hand;
using test::LimitShares;

constexpr std::uint64_t kToolSeed = 20251123;

struct ToolDraw {
  MachineModel machine;
  JointVector at{};
};

/// The limits of bench_machine() on another chain of joints.
[[nodiscard]] MachineModel with_limits(MachineModel machine) {
  const MachineModel bench = test::bench_machine();
  for (JointSpec& joint : machine.joints) {
    joint.limits = bench.joints[joint.is_rotary ? 4 : 0].limits;
  }
  machine.max_feed_mm_per_s = bench.max_feed_mm_per_s;
  return machine;
}

/// An arm in front of its workpiece, the elbow up.
template <class Uniform>
[[nodiscard]] ToolDraw draw_robot(const Uniform& uniform) {
  ToolDraw draw{with_limits(test::robot_machine(true)), {}};
  const Vector3 axis(uniform(-0.5, 0.5), uniform(-0.5, 0.5), 1);
  const ToolPose pose{Vector3(uniform(-100, 100), uniform(-100, 100), uniform(0, 100)),
                      axis.normalized()};
  draw.at = solve(draw.machine, draw.machine.tool_length_mm, pose, 0, draw.at).q;
  return draw;
}

[[nodiscard]] ToolDraw draw_tool(int n, std::mt19937_64& random) {
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  ToolDraw draw{n % 3 == 0   ? test::lai_machine()
                : n % 3 == 1 ? test::hybrid_machine()
                             : with_limits(test::trunnion_machine()),
                {}};
  if (n % 7 == 0) return draw_robot(uniform);
  for (std::size_t i = 0; i < 3; ++i) draw.at[i] = uniform(-150, 150);
  draw.at[3] = uniform(-0.9, 0.9);
  // From the pole itself to far away.
  draw.at[4] = (n % 2 == 0 ? 1 : -1) * std::exp(uniform(std::log(1e-4), std::log(1.0)));
  return draw;
}

/// How far tip and axis are off the straight way through `begin`.
void expect_on_path(const test::CycleWorld& world, std::size_t first, const ToolPose& begin,
                    const ToolPath& tool_path) {
  double tip_off = 0, axis_off = 0;
  for (std::size_t n = first; n < world.records.size(); n += 7) {
    const ToolPose pose =
        forward(world.machine, world.machine.tool_length_mm, world.records[n].joints);
    const Vector3 moved = pose.tip - begin.tip, direction = to_vector(tool_path.direction);
    if (tool_path.is_tilt) {
      tip_off = std::max(tip_off, moved.norm());
      const Vector3 normal = begin.axis.cross(direction);
      axis_off = std::max(axis_off, std::abs(pose.axis.dot(normal)));
    } else {
      tip_off = std::max(tip_off, (moved - moved.dot(direction) * direction).norm());
      axis_off = std::max(axis_off, (pose.axis - begin.axis).norm());
    }
  }
  EXPECT_LE(tip_off, 1e-8);
  EXPECT_LE(axis_off, 1e-10);
}

TEST(JogTool, KeepsLimitsAndItsWayWhereverTheToolStands) {
  constexpr int kHolds = test::draws(140);
  std::mt19937_64 random(kToolSeed);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  LimitShares worst, worst_fault;
  int moved = 0, tilted = 0;
  for (int n = 0; n < kHolds; ++n) {
    SCOPED_TRACE(testing::Message() << "hold " << n);
    const ToolDraw draw = draw_tool(n, random);
    Hand hand(draw.machine, draw.at);
    const int axis = kMaxJoints + n % kToolAxisCount;
    ASSERT_TRUE(hand.lay_on(axis));
    const ToolPose begin = forward(draw.machine, draw.machine.tool_length_mm, draw.at);
    const std::size_t first = hand.world.records.size();
    const bool is_tilt = axis - kMaxJoints >= 3;
    for (int k = 0; k < 6; ++k) {
      hand.hold(axis, (is_tilt ? 1 : 100) * uniform(-2, 2), uniform(0.05, 1.0));
    }
    const ToolPath tool_path = hand.world.state.jogging.tool_path;
    const std::size_t shown = is_tilt ? 4 : 0;
    const bool has_moved = std::abs(hand.world.state.joints[shown] - draw.at[shown]) > 1e-3;
    moved += has_moved;
    tilted += has_moved && is_tilt;
    if (n % 2 == 0) {
      EXPECT_TRUE(hand.world.run_until(State::kReady, 20));
      test::expect_within_limits(hand.world, 0, false, worst);
    } else {
      test::expect_within_limits(hand.world, 0, false, worst);
      const std::size_t fault = hand.world.records.size();
      hand.world.in.feedback.fault_mask = 1;
      EXPECT_TRUE(hand.world.run_until(State::kFault, 20));
      test::expect_within_limits(hand.world, fault, true, worst_fault);
    }
    EXPECT_EQ(hand.world.count(EventCode::kAlarm), n % 2);
    expect_on_path(hand.world, first, begin, tool_path);
  }
  std::printf(
      "seed %lu: %d of %d holds moved the tool, %d tilted it; worst v %.4f a %.4f j %.4f, in "
      "FaultStop %.4f %.4f %.4f\n",
      static_cast<unsigned long>(kToolSeed), moved, kHolds, tilted, worst.v, worst.a, worst.j,
      worst_fault.v, worst_fault.a, worst_fault.j);
  EXPECT_GT(moved, kHolds / 2);
  EXPECT_GT(worst.v, test::kIsTimed ? 0.8 : 0.5) << "as fast as the joints allow";
}

}  // namespace
}  // namespace meridian::test::jog_tool
