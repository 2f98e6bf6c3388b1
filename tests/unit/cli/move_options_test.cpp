// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/move_options.hpp"

#include <gtest/gtest.h>

#include "meridian/units.hpp"

namespace meridian::cli {
namespace {

const ToolPose kNow{{1, 2, 3}, {0, 0.6, 0.8}};

TEST(MoveOptions, KeepTheToolAxisWhereNoneIsSaid) {
  const auto pose = pose_of("-10,0.5,2e1", kNow);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->tip, Vector3(-10, 0.5, 20));
  EXPECT_EQ(pose->axis, kNow.axis);
}

TEST(MoveOptions, TakeTheToolAxisBehindTheTip) {
  const auto pose = pose_of("1,2,3,0,-0.6,0.8", kNow);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->axis, Vector3(0, -0.6, 0.8));
}

TEST(MoveOptions, RefuseWhatIsNoPose) {
  for (const char* text : {"", "1", "1,2", "1,2,", "1,2,3,", "1,2,3,4", "1,2,3,4,5", "1,2,x",
                           "1,2,nan", "1,2,inf", "1, 2,3", "1,2,3,0,0,1,5", "1;2;3"}) {
    EXPECT_FALSE(pose_of(text, kNow)) << text;
  }
}

MachineModel two_joints() {
  MachineModel model;
  model.name = "small";
  model.joint_count = 2;
  model.joints[0].name = "X";
  model.joints[1].name = "C";
  model.joints[1].is_rotary = true;
  return model;
}

TEST(MoveOptions, LeaveJointsThatAreNotNamedWhereTheyAre) {
  const auto joints = joints_of("C=-90", two_joints(), {1.5, 2});
  ASSERT_TRUE(joints) << joints.error();
  EXPECT_EQ(*joints, (JointVector{1.5, units::rad_from_deg(-90)}));
  EXPECT_EQ(*joints_of("C=180,X=-3.25", two_joints(), {1.5, 2}),
            (JointVector{-3.25, units::rad_from_deg(180)}));
}

TEST(MoveOptions, RefuseWhatNamesNoJoint) {
  for (const char* text : {"Y=1", "X", "X=", "X=1mm", "X=nan", "=1", "X=1;C=2", "X=1,,C=2"}) {
    const auto joints = joints_of(text, two_joints(), {});
    ASSERT_FALSE(joints) << text;
    EXPECT_NE(joints.error().find("say a joint of machine small"), std::string::npos);
  }
}

}  // namespace
}  // namespace meridian::cli
