// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/placing.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::inspect {
namespace {

[[nodiscard]] MachineModel trunnion_of_fit() {
  return config::load_machine(test::shipped_file("trunnion-ac"));
}

/// Poses with an upright tool, lines counted from 1, each `feed_time_s` behind the one before.
[[nodiscard]] std::vector<ProgramPose> upright(const std::vector<Vector3>& tips,
                                               const MachineModel& model, double feed_time_s = 1) {
  std::vector<ProgramPose> poses;
  for (const Vector3& tip : tips) {
    const auto line = static_cast<std::uint32_t>(poses.size() + 1);
    poses.push_back({{tip, Vector3::UnitZ()}, model.tool_length_mm, line, feed_time_s});
  }
  return poses;
}

[[nodiscard]] KeepOutBox box_on(int joint, double min, double max) {
  KeepOutBox box;
  box.name = {'v', 'i', 's', 'e'};
  box.joints = 1U << static_cast<unsigned>(joint);
  box.min[static_cast<std::size_t>(joint)] = min;
  box.max[static_cast<std::size_t>(joint)] = max;
  return box;
}

/// Where joint 0, X, of the trunnion machine stands with the tip at `x`.
[[nodiscard]] double slide_at(const MachineModel& model, double x) {
  return fit_of(model, upright({{x, 0, 0}}, model)).min[0];
}

TEST(Fit, IsRefusedByAKeepOutBoxThatAPoseIsIn) {
  MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {100, 0, 0}}, model);
  ASSERT_GT(fit_of(model, poses).margin, 0);
  const double there = slide_at(model, 100);
  ASSERT_TRUE(model.keep_out.add(box_on(0, there - 5, there + 5)));
  const Fit fit = fit_of(model, poses);
  EXPECT_LT(fit.margin, 0);
  EXPECT_EQ(fit.box, 0);
  EXPECT_EQ(fit.line, 2U);
}

TEST(Fit, IsRefusedByAKeepOutBoxBetweenTwoPoses) {
  MachineModel model = trunnion_of_fit();
  const double middle = 0.5 * (slide_at(model, 0) + slide_at(model, 100));
  ASSERT_TRUE(model.keep_out.add(box_on(0, middle - 1, middle + 1)));
  const auto poses = upright({{0, 0, 0}, {100, 0, 0}}, model);
  EXPECT_EQ(fit_of(model, poses).box, 0);
  EXPECT_EQ(fit_of(model, upright({{0, 0, 0}, {40, 0, 0}}, model)).box, -1);
  const auto findings = findings_of(model, poses, 0);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].obstacle, Obstacle::kKeepOut);
  EXPECT_EQ(findings[0].first_line, 2U);
}

TEST(Fit, SeesWhereTheTipLeavesItsBox) {
  MachineModel model = config::load_machine(test::shipped_file("fork-ca"));
  const auto poses = upright({{0, 0, 0}, {100, 0, 0}}, model);
  ASSERT_GT(fit_of(model, poses).margin, 0);
  model.tip_box = {true, {-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}};
  EXPECT_EQ(fit_of(model, poses).tip_axis, -1);
  model.tip_box.max[0] = model.X_MW.origin_mm[0] + 60;
  const Fit fit = fit_of(model, poses);
  EXPECT_EQ(fit.tip_axis, 0);
  EXPECT_LT(fit.margin, 0);
  const auto findings = findings_of(model, poses, fit.branch);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].obstacle, Obstacle::kTipBox);
  EXPECT_NEAR(findings[0].farthest, 40, 1e-9);
  EXPECT_EQ(findings[0].first_line, 2U);
  const Placing found = find_placing(model, poses, widest_box(model, poses));
  EXPECT_GT(found.fit.margin, 0) << to_text(found, model, poses);
}

TEST(Fit, NamesEveryJointThatIsBeyondItsTravelWithItsLines) {
  const MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {1000, 0, 0}, {1100, 2000, 0}, {0, 0, 0}}, model);
  const auto findings = findings_of(model, poses, fit_of(model, poses).branch);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].number, 0);
  EXPECT_EQ(findings[0].lines, 2);
  EXPECT_EQ(findings[0].first_line, 2U);
  EXPECT_EQ(findings[0].last_line, 3U);
  EXPECT_EQ(findings[0].farthest_line, 3U);
  EXPECT_NEAR(findings[0].farthest, 1100 - model.joints[0].limits.travel_max, 1e-9);
  EXPECT_EQ(findings[1].number, 1);
  EXPECT_EQ(findings[1].lines, 1);
}

TEST(Fit, HasNoFindingWhereTheProgramFits) {
  const MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {10, 0, 0}}, model);
  EXPECT_TRUE(findings_of(model, poses, fit_of(model, poses).branch).empty());
}

TEST(Fit, EstimatesTheTimeByFeedWhereJointsAreQuickEnough) {
  const MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, model);
  EXPECT_NEAR(estimated_time_s(model, poses, fit_of(model, poses).branch), 3, 1e-12);
}

TEST(Fit, EstimatesTheTimeByTheJointsWhereTheyAreSlower) {
  const MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {300, 0, 0}}, model, 0);
  const double velocity = model.joints[0].limits.velocity;
  EXPECT_NEAR(estimated_time_s(model, poses, fit_of(model, poses).branch), 300 / velocity, 1e-9);
  const auto there_and_back = upright({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, model, 0);
  EXPECT_GT(estimated_time_s(model, there_and_back, 0), 2 * 1 / velocity)
      << "it turns round no faster than its acceleration allows";
}

TEST(Placing, LeavesKeepOutBoxesAlone) {
  MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}}, model);
  const PlacingBox box = widest_box(model, poses);
  const double middle =
      0.5 * (model.joints[0].limits.travel_min + model.joints[0].limits.travel_max);
  ASSERT_TRUE(model.keep_out.add(box_on(0, middle - 50, middle + 60)));
  const Placing found = find_placing(model, poses, box);
  ASSERT_GT(found.fit.margin, 0) << to_text(found, model, poses);
  EXPECT_TRUE(found.fit.max[0] <= middle - 50 || found.fit.min[0] >= middle + 60)
      << to_text(found, model, poses);
}

TEST(Placing, SaysWhichKeepOutBoxIsInTheWayWhereNothingFits) {
  MachineModel model = trunnion_of_fit();
  const auto poses = upright({{0, 0, 0}, {100, 0, 0}}, model);
  const PlacingBox box = widest_box(model, poses);
  ASSERT_TRUE(model.keep_out.add(box_on(2, -1e5, 1e5)));
  const Placing found = find_placing(model, poses, box);
  EXPECT_LT(found.fit.margin, 0);
  const std::string text = to_text(found, model, poses);
  EXPECT_NE(text.find("keep-out box vise is entered in 2 lines, 1 to 2"), std::string::npos)
      << text;
}

TEST(Placing, LooksForTheFrameWithTheLeastTimeWhereThatIsAsked) {
  MachineModel model = trunnion_of_fit();
  for (std::size_t i = 3; i < 5; ++i) {  // a table that never holds the slides back
    model.joints[i].limits.velocity *= 100;
    model.joints[i].limits.acceleration *= 100;
  }
  // The tool swings to and fro: the nearer the tip is to the axis of the table, the less the
  // slides have to follow.
  std::vector<ProgramPose> poses;
  for (int n = 0; n < 40; ++n) {
    const double tilt = n % 2 == 0 ? 0.2 : 0.6;
    poses.push_back({{Vector3(0, 0, 0), Vector3(0, std::sin(tilt), std::cos(tilt))},
                     model.tool_length_mm,
                     static_cast<std::uint32_t>(n + 1),
                     0});
  }
  PlacingBox box{{-300, -300, -100}, {300, 300, 200}, false};
  const Placing widest = find_placing(model, poses, box);
  const Placing quick = find_placing(model, poses, box, PlacingAim::kTime);
  EXPECT_GE(quick.fit.margin, kTimeMargin);
  const auto time_at = [&](const std::array<double, 3>& origin) {
    const MachineModel there = placed(model, origin, 0);
    return estimated_time_s(there, poses, fit_of(there, poses).branch);
  };
  EXPECT_LE(time_at(quick.origin_mm), time_at(widest.origin_mm));
  EXPECT_LT(time_at(quick.origin_mm), 0.5 * time_at({0, 300, 200}));
}

}  // namespace
}  // namespace meridian::inspect
