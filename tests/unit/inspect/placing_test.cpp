// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/placing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::inspect {
namespace {

/// The corners of a plate, `width` wide, with an upright tool.
std::string plate(double width) {
  std::string text = "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\n";
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
    text += "GOTO/" + std::to_string(x * width) + "," + std::to_string(y * width) + ",0,0,0,1\n";
  }
  return text + "FINI\n";
}

std::vector<ProgramPose> poses_of(const std::string& text, const MachineModel& model) {
  cl::ClReader reader(std::string_view(text), "part.apt");
  const auto poses = read_poses(reader, model, ToolTable());
  EXPECT_TRUE(poses) << (poses ? "" : poses.error().text());
  return poses ? *poses : std::vector<ProgramPose>{};
}

MachineModel trunnion() { return config::load_machine(test::shipped_file("trunnion-ac")); }

TEST(Placing, PutsAPlateInTheMiddleOfTheTravelOfEachAxis) {
  const MachineModel model = trunnion();
  const auto poses = poses_of(plate(300), model);
  const Placing found = find_placing(model, poses, widest_box(model, poses));
  ASSERT_GT(found.fit.margin, 0.7) << to_text(found, model, poses);
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = model.joints[i].limits;
    const double middle = 0.5 * (limits.travel_min + limits.travel_max);
    EXPECT_NEAR(0.5 * (found.fit.min[i] + found.fit.max[i]), middle, 5)
        << model.joints[i].name << "\n"
        << to_text(found, model, poses);
  }
  EXPECT_NE(to_text(found, model, poses).find("--frame "), std::string::npos);
}

TEST(Placing, SaysWhichJointIsTooShortWhereNothingFits) {
  const MachineModel model = trunnion();
  const auto poses = poses_of(plate(1500), model);
  const Placing found = find_placing(model, poses, widest_box(model, poses));
  EXPECT_LT(found.fit.margin, 0);
  const std::string text = to_text(found, model, poses);
  EXPECT_NE(text.find("nowhere in this box"), std::string::npos) << text;
  EXPECT_NE(text.find("X goes 50.0"), std::string::npos) << "1500 mm in 1400\n" << text;
}

TEST(Placing, KeepsToTheBox) {
  const MachineModel model = trunnion();
  const auto poses = poses_of(plate(100), model);
  const PlacingBox box{{-650, 10, 20}, {-600, 12, 20}, false};
  const Placing found = find_placing(model, poses, box);
  EXPECT_NEAR(found.origin_mm[0], -600, 0.1) << "farthest from the end of X";
  EXPECT_GE(found.origin_mm[1], 10);
  EXPECT_LE(found.origin_mm[1], 12);
  EXPECT_EQ(found.origin_mm[2], 20);
}

TEST(Placing, TurnsTheWorkpieceWhereThatHelps) {
  MachineModel model = trunnion();
  model.joints[1].limits.travel_min = -60;
  model.joints[1].limits.travel_max = 60;
  const auto bar = poses_of(
      "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\nGOTO/0,400,0,0,0,1\nFINI\n", model);
  PlacingBox box = widest_box(model, bar);
  EXPECT_LT(find_placing(model, bar, box).fit.margin, 0);
  box.may_turn = true;
  const Placing turned = find_placing(model, bar, box);
  EXPECT_GT(turned.fit.margin, 0.4) << to_text(turned, model, bar);
  EXPECT_NEAR(std::abs(std::sin(turned.turn_rad)), 1, 0.1);
}

TEST(Placing, AFrameThatFitsPutsEveryPoseInsideTravel) {
  std::mt19937 engine(5);
  int fitting = 0;
  for (const std::string& name : test::shipped_machines()) {
    const MachineModel bare = config::load_machine(test::shipped_file(name));
    const auto poses = poses_of(plate(120), bare);
    const PlacingBox box = widest_box(bare, poses);
    for (int n = 0; n < 100; ++n) {
      std::array<double, 3> origin{};
      for (std::size_t i = 0; i < 3; ++i) {
        origin[i] = std::uniform_real_distribution<>(box.low_mm[i], box.high_mm[i])(engine);
      }
      const MachineModel model = placed(bare, origin, 0);
      const Fit fit = fit_of(model, poses);
      if (fit.margin < 0) continue;
      ++fitting;
      for (const ProgramPose& at : poses) {
        JointVector q = solve(model, at.tool_length_mm, at.pose, fit.branch, JointVector{}).q;
        wind_into_travel(model, JointVector{}, q);
        EXPECT_LT(first_joint_outside_travel(model, q, 1e-9), 0) << name << ", line " << at.line;
      }
      MachineModel again = bare;
      config::place_workpiece(again, config::parse_frame(frame_text(model)));
      EXPECT_LT((again.X_MW.rotation - model.X_MW.rotation).norm(), 1e-7);
      EXPECT_LT((again.X_MW.origin_mm - model.X_MW.origin_mm).norm(), 2e-3);
    }
  }
  EXPECT_GT(fitting, 100);
}

TEST(ProgramPoses, SeeWhereAnArcBulges) {
  const MachineModel model = trunnion();
  const auto poses = poses_of(
      "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/50,0,0,0,0,1\n"
      "CIRCLE/0,0,0,0,0,1,50\nGOTO/-50,0,0,0,0,1\nFINI\n",
      model);
  double max = 0;
  for (const ProgramPose& at : poses) max = std::max(max, std::abs(at.pose.tip.y()));
  EXPECT_NEAR(max, 50, 0.2);
}

}  // namespace
}  // namespace meridian::inspect
