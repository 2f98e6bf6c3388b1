// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "integration/drawn_program.hpp"

/// Programs anywhere among keep-out boxes anywhere: preflight, planner and the guard of the cycle
/// say the same.
namespace meridian {
namespace {

/// One to four boxes of one to three joints, none of which holds home.
KeepOut drawn_keep_out(const MachineModel& own, test::Engine& engine) {
  KeepOut out;
  JointVector home{};
  for (int i = 0; i < own.joint_count; ++i) home[i] = own.joints[i].home;
  const auto count = 1 + engine() % 4;
  while (out.boxes().size() < count) {
    KeepOutBox box;
    for (std::uint64_t n = 1 + engine() % 3; n > 0; --n) {
      const auto joint = static_cast<std::size_t>(engine() % 5);
      if (own.joints[joint].is_endless) continue;
      const bool is_rotary = own.joints[joint].is_rotary;
      std::uniform_real_distribution<double> middle(is_rotary ? -0.8 : -150, is_rotary ? 0.8 : 150);
      std::uniform_real_distribution<double> half(0.001, is_rotary ? 0.3 : 60);
      const double at = home[joint] + middle(engine), by = half(engine);
      box.joints |= 1U << joint;
      box.min[joint] = at - by;
      box.max[joint] = at + by;
    }
    if (box.joints != 0 && depth_inside(box, home) < 0) (void)out.add(box);
  }
  return out;
}

/// How near the setpoints come to a box: the largest depth, negative outside.
double nearest(const std::vector<CycleRecord>& records, const MachineModel& model) {
  double depth = -1e9;
  for (const CycleRecord& record : records) {
    for (const KeepOutBox& box : model.keep_out.boxes()) {
      depth = std::max(depth, depth_inside(box, record.joints));
    }
  }
  return depth;
}

TEST(DrawnKeepOut, IsSeenByPreflightPlannerAndGuardAlike) {
  constexpr unsigned kSeed = 20261128;
  const auto narrow = [](const MachineModel& own, test::Engine& engine) {
    MachineModel model = own;
    model.keep_out = drawn_keep_out(own, engine);
    return model;
  };
  test::DrawnCounts counts;
  test::check_drawn_programs(
      kSeed, narrow,
      [](const test::DrawnRun& drawn) {
        test::expect_box_kept(drawn, Alarm::kKeepOut, nearest, kKeepOutRounding);
      },
      counts);
  EXPECT_GT(counts.run, counts.programs / 10);
  EXPECT_GT(counts.refused_first, counts.programs / 20);
  EXPECT_GT(counts.refused_between, counts.programs / 10);
}

}  // namespace
}  // namespace meridian
