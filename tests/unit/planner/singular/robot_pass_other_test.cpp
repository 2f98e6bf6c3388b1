// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "service/core/planner/singular/robot/pass_joints.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"
#include "unit/planner/singular/wrist_path.hpp"

/// Passes of a robot at one of its singularities where the other one is near.
namespace meridian::test::robot_pass_other {
namespace {

using wrist_path::WristPath;

/// At u = 10 mm the bend is `beside_rad` and the wrist point `off_axis_mm` beside the base axis.
struct Near {
  Singularity at;
  double beside_rad, off_axis_mm, axis_tolerance_rad, tip_tolerance_mm;
  double nearest, to;
  bool rests = false;
};

struct Found {
  explicit Found(const Near& near)
      : path(wrist_path::path_past_both(near.beside_rad, near.off_axis_mm)),
        task{path.model,
             path,
             path.axes,
             path.tips,
             path.model.tool_length_mm,
             near.axis_tolerance_rad,
             near.tip_tolerance_mm,
             false} {
    PassRange range = path.range();
    range.at = near.at;
    range.nearest = near.nearest;
    range.to = near.to;
    if (near.rests) range.rests_at_to = only(near.at);
    pass = find_robot_pass(task, range);
  }
  /// The least distance to the other singularity on the pass, in tolerances of it.
  [[nodiscard]] double off_other() const {
    JointVector q = path.begin_joints;
    double smallest = 1e9;
    for (int k = 0; k <= 2000; ++k) {
      const double u = pass.begin + (pass.end - pass.begin) * k / 2000;
      q = joints_on_pass(task, pass, u, q).q;
      smallest = std::min(smallest, off_other_singularity(task, pass, u, q).norm());
    }
    return smallest / other_tolerance(task, pass);
  }

  WristPath path;
  PassTask task;
  RobotPass pass;
};

/// On its own the other one would turn its joint fast, unseen by the tolerance.
TEST(RobotPassOther, APassAtOneSingularityDrivesBothWhereItWouldMeetTheOther) {
  for (const Near& near : {
           Near{Singularity::kShoulder, -0.036, -0.769, 0.0483, 0.00222, 10, 11.852},
           Near{Singularity::kShoulder, -0.00134, 3.54, 0.0145, 0.00325, 10, 10, true},
           Near{Singularity::kShoulder, 0.000174, 0.301, 0.00587, 0.00316, 10, 10, true},
       }) {
    const Found found(near);
    ASSERT_GT(found.pass.end, found.pass.begin);
    EXPECT_EQ(found.pass.at, SingularSet::kWristAndShoulder);
  }
}

TEST(RobotPassOther, ANarrowPassAtOneSingularityKeepsClearOfTheOther) {
  for (const Near& near : {
           Near{Singularity::kShoulder, -0.00335, 0.631, 0.0016, 0.196, 9.3817, 20},
           Near{Singularity::kShoulder, -0.000517, 0.00273, 0.00228, 0.00105, 9.9973, 10.31},
       }) {
    const Found found(near);
    ASSERT_GT(found.pass.end, found.pass.begin);
    ASSERT_EQ(found.pass.at, SingularSet::kShoulder);
    EXPECT_GE(found.off_other(), 1);
  }
}

TEST(RobotPassOther, APassThatMeetsOneSingularityDrivesItsJointAlone) {
  for (const Near& near : {
           Near{Singularity::kWrist, 5.37e-5, 0.12, 0.00845, 0.0761, 10, 10, true},
           Near{Singularity::kShoulder, -0.0227, 18.4, 0.0378, 0.0159, 0, 20},
       }) {
    const Found found(near);
    ASSERT_GT(found.pass.end, found.pass.begin);
    EXPECT_EQ(found.pass.at, only(near.at));
    EXPECT_GE(found.off_other(), 1);
  }
}

}  // namespace
}  // namespace meridian::test::robot_pass_other
