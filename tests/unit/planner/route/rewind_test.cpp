// SPDX-License-Identifier: Apache-2.0

/// How a router winds its redundant joint back off the part.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/kinematics/winding.hpp"
#include "support/machines.hpp"
#include "unit/planner/route/approached.hpp"

namespace meridian::test::approach {
namespace {

TEST(Rewind, TurnsTheRedundantJointOffThePartAndComesBack) {
  for (const int turns : {-1, 1}) {
    MachineModel model = lai_machine();
    model.rewind_retract_mm = 30;
    Approached one(model);
    ASSERT_FALSE(is_fault(one.router.rewind(cut({0, 0, 0}, tilted(0.3, 0.4)), {one.start, turns},
                                            one.cursor, *one.staged)));
    const auto paths = one.paths();
    ASSERT_EQ(paths.size(), 3U);
    EXPECT_NEAR((to_vector(paths[0].tip_delta) - 30 * tilted(0.3, 0.4)).norm(), 0, kRounding);
    EXPECT_EQ(paths[1].kind, PathKind::kJoint);
    EXPECT_NEAR(paths[1].joints_end[3] - paths[1].joints_begin[3], turns * kTurn_rad, kRounding);
    EXPECT_NEAR((to_vector(paths[2].tip_delta) + 30 * tilted(0.3, 0.4)).norm(), 0, kRounding);
    for (const PathPiece& path : paths) EXPECT_EQ(path.motion, MotionKind::kRewind);
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(one.cursor.joints[i], one.start[i] + (i == 3 ? turns * kTurn_rad : 0), 1e-9);
    }
    EXPECT_EQ(one.cursor.pose.tip, Vector3::Zero());
    EXPECT_EQ(one.staged->times[0].feed_mm_per_s, 0);
    EXPECT_EQ(one.staged->times[one.staged->time_count - 1].feed_mm_per_s,
              model.approach_feed_mm_per_s);
  }
}

TEST(Rewind, IsRefusedWhereThereIsNoRoomForAllOfIt) {
  MachineModel model = lai_machine();
  model.rewind_retract_mm = 30;
  Approached probe(model);
  ASSERT_FALSE(is_fault(probe.router.rewind(cut({0, 0, 0}, tilted(0.3, 0.4)), {probe.start, 1},
                                            probe.cursor, *probe.staged)));
  const PathPiece up = probe.paths()[0];
  const double by = up.joints_end[2] - up.joints_begin[2];
  JointLimits& limits = model.joints[2].limits;
  (by > 0 ? limits.travel_max : limits.travel_min) = up.joints_begin[2] + 0.99 * by;
  Approached one(model);
  EXPECT_EQ(
      one.router.rewind(cut({0, 0, 0}, tilted(0.3, 0.4)), {one.start, 1}, one.cursor, *one.staged)
          .kind,
      PathFault::Kind::kTravel);
  EXPECT_EQ(one.staged->path_count, 0);
}

}  // namespace
}  // namespace meridian::test::approach
