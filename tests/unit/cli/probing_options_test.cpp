// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/probing_options.hpp"

#include <gtest/gtest.h>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian::cli {
namespace {

constexpr double kExact_mm = 1e-9;

TEST(ProbingOptions, NameADirectionOfTheWorkFrame) {
  EXPECT_EQ(axis_of_work_frame("-y"), Vector3(0, -1, 0));
  EXPECT_EQ(axis_of_work_frame("+z"), Vector3(0, 0, 1));
  EXPECT_FALSE(axis_of_work_frame("y"));
}

TEST(ProbingOptions, SayOfAContactWhereItWasAndHowWellThatIsKnown) {
  const MachineModel model = test::lai_machine();
  dds::Status status;
  status.tool_length_mm = 80;
  const ToolPose at = forward(model, 80, JointVector{});
  const auto joints_at = [&](double x) {
    return solve(model, 80, ToolPose{at.tip + Vector3(x, 0, 0), at.axis}, 0, {}).q;
  };
  status.contact_free_joints = joints_at(5);
  status.contact_joints = joints_at(5.25);
  status.joints = joints_at(6);
  const ContactReport found = contact_of(status, model);
  EXPECT_LT((found.tip - at.tip - Vector3(5.25, 0, 0)).norm(), kExact_mm);
  EXPECT_NEAR(found.uncertainty_mm, 0.25, kExact_mm);
  EXPECT_NEAR(found.overtravel_mm, 0.75, kExact_mm);
}

}  // namespace
}  // namespace meridian::cli
