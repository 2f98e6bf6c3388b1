// SPDX-License-Identifier: Apache-2.0
// Programs for a machine whose stage stands between joints and drives: the words are the drives'.
#include <gtest/gtest.h>

#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "service/programs/post/axis_words.hpp"
#include "service/programs/post/drive_line.hpp"
#include "support/machines.hpp"
#include "support/nc_program.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

constexpr const char* kTurning =
    "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/20,0,10,0,0,1\nGOTO/30,5,10,0.1,0.1,0.98995\n"
    "RAPID\nGOTO/30,5,60,0.1,0.1,0.98995\nFINI\n";

/// A program for a staged machine, read as its controller would.
struct Read {
  const MachineModel& model;
  test::NcProgramRead nc;
  post::AxisWords words = *post::AxisWords::of(model);

  [[nodiscard]] ToolPose end_of(const test::NcMove& move) const {
    JointVector u{};
    for (int i = 0; i < model.joint_count; ++i) u[i] = words.axis(i, move.at.at(words.address(i)));
    return forward(model, model.tool_length_mm, joints_of(model, u));
  }
};

TEST(StageProgram, SaysWhereTheSlidersAreAndNothingOfTheJointsTheyCarry) {
  const MachineModel model = test::shipped("lai-hybrid");
  const auto program = test::written(kTurning, model);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_NE(program->text.find("(U AND V ARE THE SLIDERS OF A STAGE"), std::string::npos);
  const Read read{model, test::read_nc(program->text)};
  ASSERT_FALSE(read.nc.moves.empty());
  const test::NcMove& last = read.nc.moves.back();
  EXPECT_EQ(last.at.count("C") + last.at.count("Y"), 0U);
  const ToolPose end = read.end_of(last);
  EXPECT_LT((end.tip - Vector3(30, 5, 60)).norm(), 2e-3);
  EXPECT_LT((end.axis - Vector3(0.1, 0.1, 0.98995).normalized()).norm(), 2e-5);
}

TEST(StageProgram, TheTipRunsAtItsFeedThoughTheDrivesRunEvenly) {
  const MachineModel model = test::shipped("lai-hybrid");
  const auto program = test::written(kTurning, model);
  ASSERT_TRUE(program) << program.error().message;
  const Read read{model, test::read_nc(program->text)};
  constexpr double kFeed_mm_per_s = 10;
  double covered = 0, time = 0;
  for (std::size_t n = 1; n < read.nc.moves.size(); ++n) {
    const test::NcMove& before = read.nc.moves[n - 1];
    const test::NcMove& move = read.nc.moves[n];
    if (!before.is_inverse || move.is_rapid) continue;
    const ToolPose from = read.end_of(before), to = read.end_of(move);
    constexpr double kPlane_mm = 10;  // of the cut; the way down to it has another feed
    if (std::abs(from.tip.z() - kPlane_mm) > 1e-3 || std::abs(to.tip.z() - kPlane_mm) > 1e-3) {
      continue;
    }
    const double length = (to.tip - from.tip).norm(), seconds = 60 / move.feed;
    EXPECT_NEAR(length / seconds, kFeed_mm_per_s, 0.05) << "NC line " << move.line;
    covered += length;
    time += seconds;
  }
  EXPECT_NEAR(covered, std::hypot(10, 5), 0.01);
  EXPECT_NEAR(time, covered / kFeed_mm_per_s, 1e-3 * time + 1e-3);
}

TEST(StageProgram, WithARapidFeedNoBlockLeavesTheSlidersToThemselves) {
  post::PostOptions options;
  options.rapid_feed_mm_per_s = 100;
  const auto program = test::written(kTurning, test::shipped("lai-hybrid"), options);
  ASSERT_TRUE(program) << program.error().message;
  for (const std::string& line : test::read_nc(program->text).lines) {
    const bool has_slider =
        line.find(" U") != std::string::npos || line.find(" V") != std::string::npos;
    EXPECT_FALSE(has_slider && line.find("G0 ") != std::string::npos) << line;
  }
}

TEST(StageProgram, ToolCentreWordsAreRefusedByTheNamesOfTheSliders) {
  for (const auto dialect :
       {post::Dialect::kFanuc, post::Dialect::kSiemens, post::Dialect::kHeidenhain}) {
    post::PostOptions options;
    options.dialect = dialect;
    const auto program = test::written(kTurning, test::shipped("lai-hybrid"), options);
    ASSERT_FALSE(program);
    EXPECT_NE(program.error().message.find("sliders u1 and u2"), std::string::npos)
        << program.error().message;
  }
}

TEST(StageProgram, WhereTheStageDoesNotReachTheSliderIsNamed) {
  MachineModel model = test::shipped("lai-hybrid");
  model.stage_drives[1].limits.travel_max = model.stage_drives[1].home + 1;
  const auto program = test::written(kTurning, model);
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message.find("u2 at"), std::string::npos) << program.error().message;
}

TEST(StageProgram, ASliderWithoutAWordIsNotGuessed) {
  MachineModel model = test::shipped("lai-hybrid");
  model.stage_drives[0].nc_word.clear();
  const auto program = test::written(kTurning, model);
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message.find("[stage.u1]"), std::string::npos)
      << program.error().message;
}

/// All stages on one machine: both assemblies of both kinds of rods, and the slots.
std::vector<MachineModel> staged_machines() {
  std::vector<MachineModel> out;
  for (const double side1 : {1.0, -1.0}) {
    for (const double side2 : {1.0, -1.0}) {
      MachineModel model = test::hybrid_machine();
      model.stage.side1 = side1;
      model.stage.side2 = side2;
      out.push_back(model);
    }
  }
  out.push_back(test::hybrid_machine());
  out.back().stage.kind = StageKind::kPinSlot;
  return out;
}

TEST(DriveLine, BoundsWhatTheJointsDoWhileDrivesRunStraight) {
  std::mt19937_64 random(20261121);
  const auto draw = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  constexpr int kParts = 40;
  double tightest = 0;
  int known = 0;
  for (const MachineModel& model : staged_machines()) {
    const auto s = static_cast<std::size_t>(model.stage.linear_joint);
    const auto phi = static_cast<std::size_t>(model.stage.rotary_joint);
    for (int n = 0; n < 2000; ++n) {
      JointVector q{};
      q[s] = draw(-100, 100);
      q[phi] = draw(-1, 1);
      const JointVector a = drives_of(model, q);
      const double size = std::pow(10, draw(-2, 0));
      q[s] += draw(-50, 50) * size;
      q[phi] = std::clamp(q[phi] + draw(-0.4, 0.4) * size, -1.04, 1.04);
      const JointVector b = drives_of(model, q);
      const post::DriveLine line = post::bound_drive_line(model, a, b);
      if (!line.is_known) continue;
      ++known;
      for (int k = 1; k < kParts; ++k) {
        const auto at = [&](int step) {
          return joints_of(model, test::between(a, b, static_cast<double>(step) / kParts));
        };
        const JointVector before = at(k - 1), here = at(k), after = at(k + 1);
        for (const std::size_t i : {s, phi}) {
          const double rate = std::abs(after[i] - before[i]) * kParts / 2;
          const double bend =
              std::abs(after[i] - 2 * here[i] + before[i]) * kParts * static_cast<double>(kParts);
          ASSERT_LE(rate, line.rate[i] * (1 + 1e-9) + 1e-9);
          ASSERT_LE(bend, line.bend[i] * (1 + 1e-9) + 1e-8);
          if (line.bend[i] > 1e-3) tightest = std::max(tightest, bend / line.bend[i]);
        }
      }
    }
  }
  std::printf("%d lines bounded, up to %.2f of the bound\n", known, tightest);
  EXPECT_GT(known, 5000);
  EXPECT_GT(tightest, 0.2);  // a bound far above would cut blocks for nothing
}

TEST(DriveLine, AJointWithADriveOfItsOwnRunsEvenly) {
  const MachineModel model = test::lai_machine();
  const auto line = post::bound_drive_line(model, {1, 2, 3, 0.1, 0.2}, {2, 0, 3, 0.4, 0.1});
  EXPECT_TRUE(line.is_known);
  EXPECT_EQ(line.rate[1], 2);
  EXPECT_EQ(line.bend, JointVector{});
}

}  // namespace
}  // namespace meridian
