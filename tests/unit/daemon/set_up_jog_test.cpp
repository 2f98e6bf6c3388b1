// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/monitoring/set_up_jog.hpp"

#include <gtest/gtest.h>

#include "support/machines.hpp"

namespace meridian::interpolator {
namespace {

constexpr double kSetUpSpeed = 2000.0 / 60;  // mm/s

monitoring::Limits limits_of_set_up() {
  monitoring::Limits limits;
  limits.axis_count = 5;
  for (monitoring::AxisLimits& axis : limits.axes) axis.set_up_speed = kSetUpSpeed;
  limits.axes[3].set_up_speed = limits.axes[4].set_up_speed = 0.2;
  return limits;
}

double slowed_down(bool is_tool, int joint, double velocity) {
  JogOrder order;
  order.is_tool = is_tool;
  order.joint = static_cast<std::uint8_t>(joint);
  order.velocity = velocity;
  order.tool_length_mm = 110;
  slow_down(order, test::lai_machine(), limits_of_set_up(), {});
  return order.velocity;
}

TEST(SetUpJog, SlowsAJointDownToTheTipsSpeed) {
  EXPECT_NEAR(slowed_down(false, 0, 300), 0.9 * kSetUpSpeed, 1e-6);
  EXPECT_NEAR(slowed_down(false, 0, -300), -0.9 * kSetUpSpeed, 1e-6) << "either way";
  EXPECT_EQ(slowed_down(false, 0, 5), 5) << "who is slower stays so";
}

TEST(SetUpJog, SlowsATiltDownWhereItsTipIsFarAway) {
  EXPECT_NEAR(slowed_down(false, 4, 1), 0.9 * kSetUpSpeed / 250, 1e-6) << "250 mm to the tip";
  EXPECT_NEAR(slowed_down(false, 3, 1), 0.9 * 0.2, 1e-9) << "the table turns under the tip";
}

TEST(SetUpJog, SlowsTheToolDown) {
  EXPECT_NEAR(slowed_down(true, static_cast<int>(ToolAxis::kZ), 100), 0.9 * kSetUpSpeed, 1e-9);
  EXPECT_LE(slowed_down(true, static_cast<int>(ToolAxis::kTiltX), 1), kSetUpSpeed / 1000);
}

}  // namespace
}  // namespace meridian::interpolator
