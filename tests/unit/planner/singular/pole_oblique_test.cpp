// SPDX-License-Identifier: Apache-2.0

/// Onto the pole and off it where the second rotary joint is oblique: the redundant joint turns.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/machines.hpp"
#include "unit/planner/route/routed.hpp"

namespace meridian::test::pole_oblique {
namespace {

using router::cut;
using router::kRounding;
using router::Routed;

constexpr int kC = 3;
constexpr double kHeld_rad = 2e-3;  // nearer to the pole the redundant joint is held
constexpr double kTilt_rad = 0.4;

/// B turns about an axis 45 degrees between y and z, C is the table.
MachineModel nutating_machine() {
  MachineModel model = bench_machine();
  model.name = "nutating";
  model.family = MachineFamily::kChain;
  const Vector3 o = Vector3::Zero();
  const std::array<ChainJoint, 5> chain{
      ChainJoint{3, true, true, Vector3::UnitZ(), o},
      ChainJoint{0, false, true, Vector3::UnitX(), o},
      ChainJoint{1, false, true, Vector3::UnitY(), o},
      ChainJoint{2, false, false, Vector3::UnitZ(), o},
      ChainJoint{4, true, false, Vector3(0, 1, 1).normalized(), Vector3(0, 0, 500)}};
  model.chain = *describe_chain(chain, Vector3::UnitZ(), Vector3(0, 0, 360));
  return model;
}

/// The axis from `kTilt_rad` onto the pole, or off it, with 30 mm of path.
struct Oblique : Routed {
  explicit Oblique(double feed, bool is_timed = false)
      : Routed(nutating_machine()), feed_(feed), is_timed_(is_timed) {}
  void enter() {
    stand_at({{0, 0, 0}, tilted(kTilt_rad, 0.7)});
    from = cursor.joints;
    ASSERT_FALSE(is_fault(route(block_to(Vector3::UnitZ()))));
    expect_joined(from);
  }
  void leave() {
    stand_at({{0, 0, 0}, Vector3::UnitZ()});
    from = cursor.joints;
    const ClBlock block = block_to(tilted(kTilt_rad, 0.7));
    ASSERT_FALSE(is_fault(route(block)));
    expect_joined(from);
    EXPECT_LT(away_from(block), kRounding);
  }
  [[nodiscard]] ClBlock block_to(const Vector3& axis) const {
    ClBlock block = cut({30, 0, 0}, axis, feed_);
    if (is_timed_) block.feed_meaning = FeedMeaning::kInverseTime;
    return block;
  }
  /// The time without the turn at rest.
  [[nodiscard]] double moving_s() const {
    double sum = 0;
    for (int n = 0; n < staged->time_count; ++n) {
      const TimePiece& time = staged->times[n];
      if (staged->paths[time.path_index].kind != PathKind::kTurn) sum += time.duration;
    }
    return sum;
  }
  /// The largest dz/dt of the tilt on piece `index`.
  [[nodiscard]] double turn_rate_on(std::size_t index) const {
    double largest = 0;
    for (int n = 0; n < staged->time_count; ++n) {
      const TimePiece& time = staged->times[n];
      if (time.path_index != index) continue;
      const PathPiece& path = staged->paths[index];
      for (int k = 0; k <= 4; ++k) {
        const double speed = state_at(time, time.duration * k / 4).ds;
        largest = std::max(largest, speed * path.axis_turn / path.length);
      }
    }
    return largest;
  }
  /// Largest angle between the axis of the joints and the programmed one.
  [[nodiscard]] double axis_off() const {
    double largest = 0;
    for (const PathPiece& path : paths()) {
      JointVector q = path.joints_begin;
      for (int n = 0; n <= 100; ++n) {
        const double s = path.length * n / 100;
        q = joints_at(model, path, s, q).q;
        const Vector3 axis = forward(model, path.tool_length_mm, q).axis;
        largest = std::max(largest, angle_between(axis, pose_at(path, s).axis));
      }
    }
    return largest;
  }

  JointVector from{};

 private:
  double feed_;
  bool is_timed_;
};

TEST(ObliquePole, IsReachedWithTheRedundantJointTurningAllTheLength) {
  Oblique one(50);
  one.enter();
  const auto paths = one.paths();
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_FALSE(paths[0].is_free_driven);
  EXPECT_NEAR(paths[0].axis_turn, kTilt_rad - kHeld_rad, kRounding);
  EXPECT_GT(std::abs(paths[0].joints_end[kC] - one.from[kC]), 0.05);
  EXPECT_TRUE(paths[1].is_free_driven) << "held where the azimuth fades";
  EXPECT_EQ(paths[1].joints_end[kC], paths[1].joints_begin[kC]);
  EXPECT_NEAR(paths[1].axis_turn, kHeld_rad, kRounding);
  EXPECT_NEAR((one.reached().tip - Vector3(30, 0, 0)).norm(), 0, kRounding);
}

TEST(ObliquePole, IsLeftByATurnAtRestAndThenWithTheRedundantJointTurning) {
  Oblique one(50);
  one.leave();
  const auto paths = one.paths();
  ASSERT_EQ(paths.size(), 3U);
  EXPECT_EQ(paths[0].kind, PathKind::kTurn);
  EXPECT_TRUE(paths[1].is_free_driven);
  EXPECT_EQ(paths[1].joints_end[kC], paths[1].joints_begin[kC]);
  EXPECT_NEAR(paths[1].axis_turn, kHeld_rad, kRounding);
  EXPECT_FALSE(paths[2].is_free_driven);
  EXPECT_GT(std::abs(paths[2].joints_end[kC] - paths[2].joints_begin[kC]), 0.05);
}

TEST(ObliquePole, CostsTheAxisLittleWhichIsReported) {
  for (const bool enters : {true, false}) {
    Oblique one(50);
    enters ? one.enter() : one.leave();
    EXPECT_GT(one.axis_off(), 1e-7);
    EXPECT_LT(one.axis_off(), 1e-6);
    EXPECT_NEAR(one.router.axis_deviation_rad(), one.axis_off(), 0.01 * one.axis_off());
  }
}

TEST(ObliquePole, TakesAsLongAsInverseTimeSaysInEveryPart) {
  constexpr double kShare_per_s = 0.1;
  for (const bool enters : {true, false}) {
    Oblique one(kShare_per_s, true);
    enters ? one.enter() : one.leave();
    EXPECT_GT(one.moving_s(), 1 / kShare_per_s);
    EXPECT_LT(one.moving_s(), 1 / kShare_per_s + 0.5);
    for (std::size_t n = 0; n < one.paths().size(); ++n) {
      if (one.paths()[n].kind == PathKind::kTurn) continue;
      EXPECT_LE(one.turn_rate_on(n), kShare_per_s * kTilt_rad) << n;
      EXPECT_GT(one.turn_rate_on(n), 0.99 * kShare_per_s * kTilt_rad) << n;
    }
  }
}

TEST(ObliquePole, HoldsTheRedundantJointOnAShortPath) {
  Routed one(nutating_machine());
  one.stand_at({{0, 0, 0}, tilted(0.9 * kHeld_rad, 0.7)});
  const JointVector from = one.cursor.joints;
  ASSERT_FALSE(is_fault(one.route(cut({2, 0, 0}, Vector3::UnitZ()))));
  ASSERT_EQ(one.paths().size(), 1U);
  EXPECT_TRUE(one.paths()[0].is_free_driven);
  EXPECT_EQ(one.cursor.joints[kC], from[kC]);
}

}  // namespace
}  // namespace meridian::test::pole_oblique
