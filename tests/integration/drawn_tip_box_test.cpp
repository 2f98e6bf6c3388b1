// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "integration/drawn_program.hpp"
#include "meridian/kinematics/tip_over_base.hpp"

/// Programs anywhere with a tip box anywhere: preflight, planner and the guard of the cycle say the
/// same.
namespace meridian {
namespace {

/// A box about where the tip is at home.
TipBox drawn_tip_box(const MachineModel& own, test::Engine& engine) {
  JointVector home{};
  for (int i = 0; i < own.joint_count; ++i) home[i] = own.joints[i].home;
  const Array3 tip = tip_over_base(own, own.tool_length_mm, home);
  std::uniform_real_distribution<double> room(40, 240);
  TipBox box{true, {}, {}};
  for (std::size_t i = 0; i < tip.size(); ++i) {
    box.min[i] = tip[i] - room(engine) * (i == 2 ? 2 : 1);
    box.max[i] = tip[i] + room(engine);
  }
  return box;
}

/// How far the setpoints come out of the box; negative inside.
double farthest(const std::vector<CycleRecord>& records, const MachineModel& model) {
  double out = -1e9;
  for (const CycleRecord& record : records) {
    const Array3 tip = tip_over_base(model, model.tool_length_mm, record.joints);
    for (std::size_t i = 0; i < tip.size(); ++i) {
      out = std::max(out, beyond_face(model.tip_box, i, tip[i]));
    }
  }
  return out;
}

TEST(DrawnTipBox, IsSeenByPreflightPlannerAndGuardAlike) {
  constexpr unsigned kSeed = 20261129;
  const auto narrow = [](const MachineModel& own, test::Engine& engine) {
    MachineModel model = own;
    model.tip_box = drawn_tip_box(own, engine);
    return model;
  };
  test::DrawnCounts counts;
  test::check_drawn_programs(
      kSeed, narrow,
      [](const test::DrawnRun& drawn) {
        test::expect_box_kept(drawn, Alarm::kTipBox, farthest, kTipBoxRounding);
      },
      counts);
  EXPECT_GT(counts.run, counts.programs / 10);
  EXPECT_GT(counts.refused_first, counts.programs / 20);
}

}  // namespace
}  // namespace meridian
