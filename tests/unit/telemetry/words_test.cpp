// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/words.hpp"

#include <gtest/gtest.h>

#include <set>

#include "meridian/cycle/state_table.hpp"
#include "meridian/units.hpp"
#include "support/machines.hpp"

namespace meridian::telemetry {
namespace {

TEST(Words, NameJointLineValueAndRemedyOfAnAlarm) {
  const MachineModel model = test::lai_machine();
  const Event event{.code = EventCode::kAlarm,
                    .cycle = 77,
                    .a = static_cast<std::uint64_t>(Alarm::kFollowingError),
                    .b = 3,
                    .x = 0.1,
                    .line = 41};
  const std::string text = describe(event, model);
  EXPECT_NE(text.find("theta1"), std::string::npos) << text;
  EXPECT_NE(text.find("deg"), std::string::npos) << text;
  EXPECT_NE(text.find("line 41"), std::string::npos) << text;
  EXPECT_NE(text.find("look for"), std::string::npos) << text;
  EXPECT_EQ(weight_of(event), Weight::kError);
}

TEST(Words, SayWhereTheAxisIsEasedByHowMuchAndWhy) {
  const RelaxedAxis relaxed_axis{7, 9, 41, 43, units::rad_from_deg(0.05), RelaxedReason::kThrough};
  EXPECT_EQ(describe(relaxed_axis),
            "lines 41 to 43: tool axis relaxed by 0.0500 deg, through the pole");
}

TEST(Words, NameTheSingularityThatARobotPasses) {
  RelaxedAxis relaxed_axis{7, 9, 41, 43, units::rad_from_deg(0.05), RelaxedReason::kThroughWrist};
  EXPECT_EQ(describe(relaxed_axis),
            "lines 41 to 43: tool axis relaxed by 0.0500 deg, through the wrist singularity");
  relaxed_axis.reason = RelaxedReason::kPastBoth;
  EXPECT_EQ(describe(relaxed_axis),
            "lines 41 to 43: tool axis relaxed by 0.0500 deg, past the wrist and shoulder "
            "singularities");
}

TEST(Words, DeclareAnApproachByJointsTimeBranchAndWinding) {
  const MachineModel model = test::lai_machine();
  Approach approach;
  approach.is_planned = true;
  approach.line = 12;
  approach.from = {10, 20, -30, 0.5, 0.1, 0};
  approach.to = {-2.5, 20, -130, 0.5 + units::rad_from_deg(360), 0, 0};
  approach.retract = 20;
  approach.descent = 50;
  approach.length = 345.678;
  approach.time = 3.21;
  approach.branch = 1;
  EXPECT_EQ(describe(approach, model, 1000),
            "approach to line 12: up 20 mm, joints straight b3 -12.5, b4 -100 mm, theta1 +360, "
            "theta2 -5.73 deg, down 50 mm, 345.7 mm in 3.2 s, branch 1, theta1 at 388.6 deg");
  approach.has_rest = true;
  const auto begins = [&](const std::string& words) {
    return describe(approach, model, 1000).rfind("approach to line 12: " + words, 0) == 0;
  };
  ASSERT_EQ(model.clearance_mm, 50);
  EXPECT_FALSE(is_short_of_clearance({}, model)) << "it begins where it begins";
  EXPECT_TRUE(begins("up 20 of 50 mm (NEAR THE PART), actions, joints ")) << "begins in its middle";
  EXPECT_TRUE(is_short_of_clearance(approach, model));
  approach.retract = 0;
  EXPECT_TRUE(begins("up 0 of 50 mm (NEAR THE PART), actions, joints "))
      << "least of all in silence";
  EXPECT_NE(describe(approach, model, 120).find("up 0 of 50 mm (NEAR THE PART)"),
            std::string::npos);
  approach.retract = 50;
  approach.lift = 70;
  EXPECT_TRUE(begins("up 50 of 50 mm, actions, up 70 mm, joints ")) << "with a longer tool";
  EXPECT_FALSE(is_short_of_clearance(approach, model));
  approach.lift = 0;
  approach.to = approach.from;
  EXPECT_EQ(
      describe(approach, model, 1000),
      "approach to line 12: up 50 of 50 mm, actions, down 50 mm, 345.7 mm in 3.2 s, branch 1, "
      "theta1 at 28.65 deg");
  approach.has_rest = false;
  approach.retract = approach.descent = 0;
  EXPECT_EQ(describe(approach, model, 1000), "approach to line 12: none, the tool is there");
}

TEST(Words, LeaveWholePartsOfAnApproachOutWhereThereIsNoRoomForThem) {
  const MachineModel model = test::lai_machine();
  Approach approach;
  approach.line = 1234567;
  approach.to = {-1234, -1234, -1234, units::rad_from_deg(-123.4), units::rad_from_deg(-123.4)};
  approach.retract = approach.descent = 123.4;
  approach.length = 1234;
  approach.time = 123.4;
  const std::string shortest = "approach to line 1234567: 1234 mm in 123.4 s, branch 0";
  const std::string all = describe(approach, model, 1000);
  EXPECT_EQ(describe(approach, model, all.size()), all);
  const std::string without_winding = describe(approach, model, all.size() - 1);
  EXPECT_EQ(without_winding + ", theta1 at -123.4 deg", all);
  EXPECT_EQ(describe(approach, model, without_winding.size()), without_winding);
  EXPECT_EQ(describe(approach, model, without_winding.size() - 1), shortest);
  EXPECT_EQ(describe(approach, model, 0), shortest);
}

TEST(Words, SayEveryAlarmDifferently) {
  const MachineModel model = test::lai_machine();
  std::set<std::string> texts;
  constexpr int kLast = static_cast<int>(Alarm::kFeedbackTooFast);
  for (int alarm = 0; alarm <= kLast; ++alarm) {
    texts.insert(describe(static_cast<Alarm>(alarm), 1, 2.5, 0, model));
  }
  EXPECT_EQ(texts.size(), std::size_t{kLast} + 1);
  EXPECT_EQ(texts.count(""), 0U);
  EXPECT_EQ(describe(static_cast<Alarm>(kLast + 1), 1, 2.5, 0, model), "") << "there are more";
}

TEST(Words, SayWhetherTheDryRunIsOn) {
  const MachineModel model = test::lai_machine();
  Event event{.code = EventCode::kAccepted, .b = static_cast<std::uint64_t>(Verb::kDryRun), .x = 1};
  EXPECT_EQ(describe(event, model).rfind("dry run on: ", 0), 0U);
  event.x = 0;
  EXPECT_EQ(describe(event, model).rfind("dry run off: ", 0), 0U);
}

TEST(Words, NameBothStatesOfAChange) {
  const Event event{.code = EventCode::kStateChanged,
                    .a = static_cast<std::uint64_t>(State::kRunning),
                    .b = static_cast<std::uint64_t>(State::kApproaching)};
  EXPECT_EQ(describe(event, test::lai_machine()), "state Approaching -> Running");
}

TEST(Words, SurviveNumbersThatNobodyMeant) {
  const MachineModel model = test::lai_machine();
  const Event event{.code = EventCode::kAlarm,
                    .a = static_cast<std::uint64_t>(Alarm::kDriveFault),
                    .b = 1'000'000};
  EXPECT_NE(describe(event, model).find("?"), std::string::npos);
}

}  // namespace
}  // namespace meridian::telemetry
