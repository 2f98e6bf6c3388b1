// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

constexpr double kDegree = units::kDegree_rad;

/// The three kinds of stages on one machine.
std::vector<MachineModel> staged_machines() {
  std::vector<MachineModel> out(3, test::hybrid_machine());
  out[1].stage.side2 = -1;  // scissor
  out[1].stage.rail_mm = 0;
  out[2].stage.kind = StageKind::kPinSlot;
  for (MachineModel& model : out) {
    for (JointSpec& drive : model.stage_drives) {
      drive.limits.travel_min = -2000;
      drive.limits.travel_max = 2000;
    }
  }
  return out;
}

TEST(Stage, GivesTheJointsOfItsDrivesBack) {
  for (const MachineModel& model : staged_machines()) {
    for (double turn = -60; turn <= 60; turn += 1) {
      const JointVector q{10, 200 * std::sin(turn), 30, turn * kDegree, 0.4};
      const JointVector back = joints_of(model, drives_of(model, q));
      for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(back[i], q[i], 1e-12) << turn;
    }
  }
}

TEST(Stage, LimitedQuantitiesAreTheJointsAndThenItsDrives) {
  const MachineModel model = test::hybrid_machine();
  const JointVector q{10, 20, 30, 0.4, 0.5};
  const JointVector u = drives_of(model, q);
  const LimitedVector all = limited_of(model, q);
  ASSERT_EQ(limited_count(model), 7);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(all[i], q[i]);
  EXPECT_EQ(all[5], u[1]);
  EXPECT_EQ(all[6], u[3]);
  EXPECT_EQ(limited_value(model, q, 6), u[3]);
  EXPECT_EQ(limited_spec(model, 5).name, "u1");
  EXPECT_EQ(drive_spec(model, 3).name, "u2");
  EXPECT_EQ(drive_spec(model, 2).name, "b4");
}

TEST(Stage, AMachineWithoutOneHasItsJointsAlone) {
  const MachineModel model = test::lai_machine();
  const JointVector q{10, 20, 30, 0.4, 0.5};
  EXPECT_EQ(limited_count(model), 5);
  EXPECT_EQ(limited_of(model, q)[5], 0);
  EXPECT_EQ(drives_of(model, q), q);
  EXPECT_EQ(joints_of(model, q), q);
  EXPECT_EQ(drive_spec(model, 3).name, "theta1");
}

TEST(Stage, JetsOfTheDrivesAreTheirDerivatives) {
  for (const MachineModel& model : staged_machines()) {
    const auto at = [&model](auto t) {
      Joints<decltype(t)> q{};
      q[1] = 40.0 * t * t - 20.0 * t;
      q[3] = 0.3 + 0.5 * t - 0.2 * t * t;
      return limited_of(model, q);
    };
    constexpr double t = 0.7, h = 1e-3;
    const Limited<Jet<3>> jets = at(Jet<3>::variable(t));
    for (std::size_t i = 5; i < 7; ++i) {
      const double a = at(t - 2 * h)[i], b = at(t - h)[i], c = at(t)[i], d = at(t + h)[i],
                   e = at(t + 2 * h)[i];
      EXPECT_NEAR(jets[i].derivative(1), (a - 8 * b + 8 * d - e) / (12 * h), 1e-6);
      EXPECT_NEAR(jets[i].derivative(2), (-a + 16 * b - 30 * c + 16 * d - e) / (12 * h * h), 1e-4);
      EXPECT_NEAR(jets[i].derivative(3), (e - 2 * d + 2 * b - a) / (2 * h * h * h), 1e-2);
    }
  }
}

TEST(Stage, JointVelocitiesComeBackFromThoseOfTheDrives) {
  for (const MachineModel& model : staged_machines()) {
    const JointVector q{1, 70, 2, -35 * kDegree, 0.3}, velocity{3, -40, 5, 0.7, 0.1};
    Joints<Jet<1>> moving;
    for (std::size_t i = 0; i < q.size(); ++i) {
      moving[i] = Jet<1>::with_derivative(q[i], velocity[i]);
    }
    const Joints<Jet<1>> u = drives_of(model, moving);
    JointVector u_velocity{};
    for (std::size_t i = 0; i < q.size(); ++i) u_velocity[i] = u[i].derivative(1);
    const JointVector back = joint_velocity_of(model, q, u_velocity);
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(back[i], velocity[i], 1e-12);
  }
}

TEST(Stage, TheDeterminantIsThatOfItsDerivatives) {
  for (const MachineModel& model : staged_machines()) {
    for (const double turn : {-55.0, -10.0, 0.0, 35.0, 60.0}) {
      const JointVector q{0, 70, 0, turn * kDegree, 0};
      const auto by = [&](std::size_t joint) {
        Joints<Jet<1>> moved;
        for (std::size_t i = 0; i < q.size(); ++i) moved[i] = Jet<1>(q[i]);
        moved[joint] = Jet<1>::variable(q[joint]);
        return drives_of(model, moved);
      };
      const auto s = by(1), phi = by(3);
      const double det =
          s[1].derivative(1) * phi[3].derivative(1) - s[3].derivative(1) * phi[1].derivative(1);
      EXPECT_NEAR(stage::determinant(model.stage, q), det, 1e-9 * std::abs(det));
    }
  }
}

TEST(Stage, NoTurnCostsMoreThanItsLever) {
  for (const MachineModel& model : staged_machines()) {
    double largest = 0;
    for (double turn = -60; turn <= 60; turn += 0.5) {
      Joints<Jet<1>> q{};
      q[3] = Jet<1>::variable(turn * kDegree);
      const Joints<Jet<1>> u = drives_of(model, q);
      largest = std::max({largest, std::abs(u[1].derivative(1)), std::abs(u[3].derivative(1))});
    }
    EXPECT_LE(largest, stage::lever_mm(model.stage) * (1 + 1e-12));
    EXPECT_GT(largest, 0.4 * stage::lever_mm(model.stage));
  }
}

TEST(Stage, ADriveThatLeavesTravelIsNamedLikeAJoint) {
  MachineModel model = test::hybrid_machine();
  const JointVector q{0, 100, 0, 20 * kDegree, 0};
  EXPECT_EQ(first_joint_outside_travel(model, q, 0), -1);
  model.stage_drives[1].limits.travel_max = drives_of(model, q)[3] - 1;
  EXPECT_EQ(first_joint_outside_travel(model, q, 0), 6);
  EXPECT_EQ(first_joint_outside_travel(model, q, 1.5), -1);
  EXPECT_EQ(first_joint_outside_travel(model, {0, 700, 0, 0, 0}, 0), 1) << "joints come first";
}

}  // namespace
}  // namespace meridian
