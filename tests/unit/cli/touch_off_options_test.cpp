// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/touch_off_options.hpp"

#include <gtest/gtest.h>

#include "service/machine/file/machine_file.hpp"

namespace meridian::cli {
namespace {

TEST(TouchOffOptions, NameDirectionsByTheAxesOfTheWorkFrame) {
  MachineModel machine;
  machine.X_MW.rotation = config::rotation_from_deg(0, 0, 90);
  ASSERT_TRUE(direction_of("+x", machine));
  EXPECT_LT((*direction_of("+x", machine) - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_LT((*direction_of("-y", machine) - Vector3::UnitX()).norm(), 1e-15);
  EXPECT_LT((*direction_of("-z", machine) + Vector3::UnitZ()).norm(), 1e-15);
  for (const char* word : {"", "x", "+a", "-zz", "z-"}) EXPECT_FALSE(direction_of(word, machine));
}

TEST(TouchOffOptions, TakeTheToolInTheSpindleAsTheTableHasIt) {
  dds::MachineInfo machine;
  machine.tool_file =
      "[[tool]]\nnumber = 4\nlength_mm = 95\nradius_mm = 3\ncorner_radius_mm = 3\n"
      "radius_wear_mm = -0.01\n[[tool]]\nnumber = 5\nlength_mm = 110\nradius_mm = 5\n";
  dds::Status status;
  status.tool = 4;
  status.tool_length_mm = 95;
  status.joints = {1, 2, 3, 4, 5, 6};
  const auto ball = touch_of(status, machine, {}, Vector3::UnitX());
  ASSERT_TRUE(ball) << ball.error();
  EXPECT_TRUE(ball->is_ball);
  EXPECT_EQ(ball->radius_mm, 3 - 0.01);
  EXPECT_EQ(ball->tool_length_mm, 95);
  EXPECT_EQ(ball->joints, status.joints);
  EXPECT_EQ(ball->toward, Vector3::UnitX());
  status.tool = 5;
  EXPECT_FALSE(touch_of(status, machine, {}, Vector3::UnitX())->is_ball);
  status.tool = 0;
  EXPECT_FALSE(touch_of(status, machine, {}, Vector3::UnitX())) << "its radius is not known";
  ToolOptions said;
  said.radius = said.corner_radius = 2;
  const auto named = touch_of(status, machine, said, Vector3::UnitX());
  ASSERT_TRUE(named) << named.error();
  EXPECT_TRUE(named->is_ball);
  EXPECT_EQ(named->radius_mm, 2);
}

}  // namespace
}  // namespace meridian::cli
