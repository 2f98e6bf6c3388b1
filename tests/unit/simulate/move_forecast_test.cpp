// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/move_forecast.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "support/machines.hpp"
#include "support/simulated_run.hpp"

namespace meridian::simulate {
namespace {

constexpr double kTip_mm = 1e-7;  // rounding of joints in reach of 1e3 mm, 1000x margin
constexpr double kAxis_rad = 1e-9;

class Move : public testing::Test {
 protected:
  /// From `joints` by so much, to `axis`.
  [[nodiscard]] stream::StraightMove by(const Vector3& displacement_mm, const Vector3& axis) const {
    const ToolPose from = forward(model, model.tool_length_mm, joints);
    return {from, {from.tip + displacement_mm, axis.normalized()}, 3000};
  }
  [[nodiscard]] MoveForecast forecast_of(const stream::StraightMove& move) const {
    return forecast(move, joints, model);
  }
  void expect_there(const stream::StraightMove& move) const {
    const MoveForecast found = forecast_of(move);
    ASSERT_EQ(found.refusal, "");
    const ToolPose end = forward(model, model.tool_length_mm, found.joints);
    EXPECT_LT((end.tip - move.to.tip).norm(), kTip_mm);
    EXPECT_LT((end.axis - move.to.axis).norm(), kAxis_rad);
  }

  MachineModel model = test::lai_machine();
  JointVector joints{30, -20, 60, units::rad_from_deg(50), units::rad_from_deg(25)};
};

TEST_F(Move, IsReadBackBitForBit) {
  const stream::StraightMove move = by({1.0 / 3, -7, 1e-5}, {0.3, -0.1, 0.9});
  const std::string text = program_of(move);
  cl::ClReader reader(std::string_view(text), "move");
  for (const ToolPose* pose : {&move.from, &move.to}) {
    const auto block = reader.next();
    ASSERT_TRUE(block && *block) << text;
    EXPECT_EQ(to_vector((*block)->tip_mm), pose->tip);
    EXPECT_EQ(to_vector((*block)->axis), pose->axis);
    EXPECT_EQ((*block)->feed, 50);
  }
  EXPECT_TRUE(reader.warnings().empty());
}

TEST_F(Move, EndsWhereItWasAskedFor) {
  const Vector3 axis = forward(model, model.tool_length_mm, joints).axis;
  expect_there(by({40, 10, -20}, axis));
  expect_there(by({0, 0, 0}, {0.1, -0.4, 0.9}));
  expect_there(by({-25, 30, 5}, {-0.2, 0.2, 0.95}));
}

TEST_F(Move, BesideThePoleTakesNoneOfTheAxisTolerance) {
  ASSERT_EQ(model.pole_policy, PolePolicy::kRelax);
  const double off_rad = 0.5 * model.tolerances.axis_rad;
  expect_there(by({40, 10, -20}, {std::sin(off_rad), 0, std::cos(off_rad)}));
  joints[4] = off_rad;
  expect_there(by({40, 10, -20}, {0, 0.4, 0.9}));
  JointVector to = joints;
  to[0] += 10;
  to[4] = -off_rad;
  const ToolPose end = forward(model, model.tool_length_mm, to);
  expect_there({end, end, 3000, to});
}

TEST_F(Move, TakesTheTimeOfItsLength) {
  const ToolPose from = forward(model, model.tool_length_mm, joints);
  const MoveForecast found = forecast_of(by({30, 40, 0}, from.axis));
  ASSERT_EQ(found.refusal, "");
  const ToolPose end = forward(model, model.tool_length_mm, found.joints);
  EXPECT_NEAR((end.tip - from.tip).norm(), 50, kTip_mm);
  EXPECT_GT(found.time_s, 1) << "50 mm at 50 mm/s, from rest to rest";
  EXPECT_LT(found.time_s, 2);
}

TEST_F(Move, WithTheToolInTheSpindle) {
  model.tool_length_mm = 83.5;
  expect_there(by({10, 0, 0}, {0.1, 0.1, 1}));
}

TEST_F(Move, BeyondTravelIsRefusedByTheJointsName) {
  const MoveForecast found = forecast_of(by({0, 0, 5000}, {0, 0.4, 0.9}));
  EXPECT_NE(found.refusal.find("b4"), std::string::npos) << found.refusal;
}

TEST_F(Move, OnWhoseWayTheRedundantJointWouldBeRewoundIsRefused) {
  model.rewind_policy = RewindPolicy::kRetract;
  model.rewind_retract_mm = 20;
  joints[3] = model.joints[3].limits.travel_max - units::rad_from_deg(2);
  int refused = 0;
  for (const double degrees : {-60.0, 60.0}) {
    const ToolPose from = forward(model, model.tool_length_mm, joints);
    const Vector3 axis =
        Eigen::AngleAxisd(units::rad_from_deg(degrees), Vector3::UnitZ()) * from.axis;
    const MoveForecast found = forecast_of(by({0, 0, 0}, axis));
    if (found.refusal.empty()) continue;
    ++refused;
    EXPECT_NE(found.refusal.find("leave its straight line"), std::string::npos) << found.refusal;
  }
  EXPECT_EQ(refused, 1) << "one way round there is travel, the other there is none";
}

TEST_F(Move, OfTheJointsGoesStraightToTheWindingThatIsNamedAtTheFeed) {
  const JointVector to{-100, 50, 80, joints[3] + 2 * std::numbers::pi, units::rad_from_deg(-30)};
  const ToolPose end = forward(model, model.tool_length_mm, to);
  double farthest = 0, fastest_mm_per_s = 0;
  const stream::StraightMove move{end, end, 1200, to};
  SimulateOptions options;
  options.start = joints;
  options.settings.transition = Transition::kExactStop;
  options.settings.first_joints = to;
  for (const CycleRecord& record : test::run_simulation(program_of(move), model, options).records) {
    if (!is_leading(record.setpoint.flags)) continue;
    const double share = (record.joints[0] - joints[0]) / (to[0] - joints[0]);
    double square = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      farthest =
          std::max(farthest, std::abs(record.joints[i] - joints[i] - share * (to[i] - joints[i])));
      const double unit_mm = i >= 3 ? 50 : 1;
      square += std::pow(unit_mm * record.setpoint.velocity[i], 2);
    }
    fastest_mm_per_s = std::max(fastest_mm_per_s, std::sqrt(square));
  }
  const MoveForecast found = forecast_of(move);
  ASSERT_EQ(found.refusal, "");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(found.joints[i], to[i], 1e-9) << i;
  EXPECT_LT(farthest, 1e-9) << "every joint its share of the way";
  EXPECT_LT(fastest_mm_per_s, 20 * (1 + 1e-9));
  EXPECT_GT(fastest_mm_per_s, 19.9);
}

TEST_F(Move, OfTheJointsIsRefusedBeyondTravel) {
  JointVector to = joints;
  to[2] = 601;
  const ToolPose end = forward(model, model.tool_length_mm, to);
  const MoveForecast found = forecast_of({end, end, 1000, to});
  EXPECT_NE(found.refusal.find("b4"), std::string::npos) << found.refusal;
}

TEST_F(Move, OfTheJointsEndsOnThePole) {
  JointVector to = joints;
  to[4] = 0;
  const ToolPose end = forward(model, model.tool_length_mm, to);
  const MoveForecast found = forecast_of({end, end, 1000, to});
  ASSERT_EQ(found.refusal, "");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(found.joints[i], to[i], 1e-9) << i;
}

TEST_F(Move, ToAnAxisThatIsNoUnitVectorIsRefused) {
  stream::StraightMove move = by({1, 0, 0}, {0, 0, 1});
  move.to.axis *= 2;
  EXPECT_NE(forecast_of(move).refusal, "");
}

}  // namespace
}  // namespace meridian::simulate
