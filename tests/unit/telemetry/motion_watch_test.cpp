// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/motion_watch.hpp"

#include <gtest/gtest.h>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian::telemetry {
namespace {

/// Record of cycle `n` of a motion with constant jerk in joint 1 (b2).
CycleRecord record_at(int n, double velocity, double acceleration, double jerk) {
  const double t = n * 1e-3;
  CycleRecord record;
  record.setpoint.cycle = static_cast<std::uint64_t>(n);
  record.joints[1] = velocity * t + acceleration * t * t / 2 + jerk * t * t * t / 6;
  record.setpoint.velocity[1] = velocity + acceleration * t + jerk * t * t / 2;
  return record;
}

TEST(MotionWatch, GivesTheTipSpeedOfTheJoints) {
  const MachineModel model = test::bench_machine();
  MotionWatch watch(model);
  CycleRecord record;
  record.joints = {10, 20, 30, 0.5, 0.4};
  record.setpoint.velocity = {7, -5, 3, 0.2, -0.1};
  watch.see(record, model.tool_length_mm);
  constexpr double kStep_s = 1e-6;
  JointVector later = record.joints, before = record.joints;
  for (std::size_t i = 0; i < 5; ++i) {
    later[i] += kStep_s * record.setpoint.velocity[i];
    before[i] -= kStep_s * record.setpoint.velocity[i];
  }
  const ToolPose a = forward(model, model.tool_length_mm, before);
  const ToolPose b = forward(model, model.tool_length_mm, later);
  constexpr double kTolerance_mm_per_s = 1e-5;  // 400 mm * eps / 2e-6 s = 4e-8, and a margin
  EXPECT_NEAR(watch.feed_mm_per_s(), (b.tip - a.tip).norm() / (2 * kStep_s), kTolerance_mm_per_s);
}

TEST(MotionWatch, NamesTheJointThatIsNearestToALimit) {
  const MachineModel model = test::bench_machine();  // 300 mm/s, 3000 mm/s², 60000 mm/s³
  MotionWatch watch(model);
  for (int n = 0; n < 10; ++n) watch.see(record_at(n, 0, 2700, 0), model.tool_length_mm);
  EXPECT_EQ(watch.limiting_joint(), 1);
  EXPECT_NEAR(watch.largest_share(), 0.9, 1e-9);
  watch.reset();
  EXPECT_EQ(watch.limiting_joint(), -1);
  for (int n = 20; n < 30; ++n) watch.see(record_at(n, 100, 0, 0), model.tool_length_mm);
  EXPECT_EQ(watch.limiting_joint(), -1) << "a third of the velocity limits nothing";
}

TEST(MotionWatch, MakesNoAccelerationOfAGapInTheRecords) {
  const MachineModel model = test::bench_machine();
  MotionWatch watch(model);
  watch.see(record_at(0, 0, 1000, 0), model.tool_length_mm);
  watch.see(record_at(1, 0, 1000, 0), model.tool_length_mm);
  watch.reset();
  watch.see(record_at(100, 0, 1000, 0), model.tool_length_mm);
  EXPECT_LT(watch.largest_share(), 0.5);
}

}  // namespace
}  // namespace meridian::telemetry
