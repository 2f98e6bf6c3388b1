// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>
#include <thread>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

/// `meridian ctl move` on a machine that runs.
namespace meridian::test {
namespace {

constexpr double kThere_mm = 1e-6;  // setpoints at rest: rounding in reach of 1e3 mm

class SetUpMove : public testing::Test {
 protected:
  void start_in_ready() {
    plant.start_service({"--service", service_file(plant)});
    (void)plant.status();
    plant.start_drives();
    ASSERT_TRUE(plant.enable()) << plant.service().said();
  }
  [[nodiscard]] ToolPose pose() {
    const dds::Status& status = plant.status();
    return forward(config::load_machine(plant.machine()), status.tool_length_mm, status.joints);
  }
  [[nodiscard]] static std::string text_of(const Vector3& tip) {
    char text[96];
    std::snprintf(text, sizeof text, "%.17g,%.17g,%.17g", tip.x(), tip.y(), tip.z());
    return text;
  }
  /// `ctl move` by so much from where the tip is, with `more` behind the tip.
  [[nodiscard]] Process move(const Vector3& by_mm, const std::string& more = "",
                             const std::string& feed = "3000") {
    return tool(plant,
                {"ctl", "move", "--tip=" + text_of(pose().tip + by_mm) + more, "--feed", feed});
  }
  void expect_joints(const JointVector& wanted) {
    const JointVector at = plant.status().joints;
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(at[i], wanted[i], 1e-9) << i;
  }
  void expect_free() {
    EXPECT_TRUE(plant.runs_until([](const dds::Status& status) {
      return status.state == State::kReady && status.session == 0;
    })) << plant.standing();
  }

  Plant plant;
};

TEST_F(SetUpMove, BringsTheTipWhereItWasAskedForAndLeavesTheMachineReady) {
  ASSERT_NO_FATAL_FAILURE(start_in_ready());
  const Vector3 tip = pose().tip;
  const Vector3 axis = pose().axis;
  Process straight = move({12, -7, 3});
  ASSERT_EQ(straight.wait(milliseconds(20'000)), 0) << straight.said();
  ASSERT_NO_FATAL_FAILURE(expect_free());
  EXPECT_LT((pose().tip - tip - Vector3(12, -7, 3)).norm(), kThere_mm);
  EXPECT_LT((pose().axis - axis).norm(), 1e-9);
  Process tilted = move({0, 0, 0}, ",0.1,0.2,0.9746794344808963");
  ASSERT_EQ(tilted.wait(milliseconds(20'000)), 0) << tilted.said();
  ASSERT_NO_FATAL_FAILURE(expect_free());
  EXPECT_LT((pose().tip - tip - Vector3(12, -7, 3)).norm(), kThere_mm);
  EXPECT_LT((pose().axis - Vector3(0.1, 0.2, 0.9746794344808963)).norm(), 1e-9);
}

TEST_F(SetUpMove, BringsJointsToNamedValuesAndToPositionsOfTheMachineFile) {
  std::ofstream(plant.machine(), std::ios::app)
      << "\n[[position]]\nname = \"change\"\njoints = [5, -4, 30, 370, -10]\n";
  ASSERT_NO_FATAL_FAILURE(start_in_ready());
  const JointVector home = plant.status().joints;
  Process named = tool(plant, {"ctl", "move", "--joints", "b3=3.5,theta1=-25", "--feed", "6000"});
  ASSERT_EQ(named.wait(milliseconds(20'000)), 0) << named.said();
  ASSERT_NO_FATAL_FAILURE(expect_free());
  JointVector wanted = home;
  wanted[0] = 3.5;
  wanted[3] = units::rad_from_deg(-25);
  expect_joints(wanted);
  Process change = tool(plant, {"ctl", "move", "--to", "change", "--feed", "20000"});
  ASSERT_EQ(change.wait(milliseconds(30'000)), 0) << change.said();
  ASSERT_NO_FATAL_FAILURE(expect_free());
  expect_joints({5, -4, 30, units::rad_from_deg(370), units::rad_from_deg(-10)});
  Process nowhere = tool(plant, {"ctl", "move", "--to", "store", "--feed", "1000"});
  EXPECT_EQ(nowhere.wait(milliseconds(20'000)), 2) << nowhere.said();
  EXPECT_NE(nowhere.said().find("there are home change"), std::string::npos) << nowhere.said();
}

TEST_F(SetUpMove, LeavesTheJournalOfAProgramThatIsNotFinishedAsItIs) {
  ASSERT_NO_FATAL_FAILURE(start_in_ready());
  ASSERT_TRUE(plant.stream(small_program(400, 1500, 0.5), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  })) << plant.station().message();
  ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.state == State::kLoaded; }));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.blocks_done > 3; }));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_NO_FATAL_FAILURE(expect_free());
  std::this_thread::sleep_for(milliseconds(300));  // until it is on the disk
  const std::string file = plant.state() / "lai.journal";
  const std::string before = read_text(file);
  ASSERT_FALSE(before.empty()) << file;
  Process away = move({0, 0, 20});
  ASSERT_EQ(away.wait(milliseconds(20'000)), 0) << away.said();
  EXPECT_EQ(away.said().find("drops that from the journal"), std::string::npos) << away.said();
  std::this_thread::sleep_for(milliseconds(1500));
  EXPECT_EQ(read_text(file), before);
}

TEST_F(SetUpMove, IsRefusedOutsideOfReadyBesideAProgramAndBeyondTravel) {
  plant.start_service();
  (void)plant.status();
  plant.start_drives();
  Process in_off = move({1, 0, 0});
  EXPECT_EQ(in_off.wait(milliseconds(20'000)), 4) << in_off.said();
  EXPECT_NE(in_off.said().find("refused: the machine is Off"), std::string::npos) << in_off.said();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  const JointVector joints = plant.status().joints;
  Process beyond = move({0, 0, -5000});
  EXPECT_EQ(beyond.wait(milliseconds(20'000)), 4) << beyond.said();
  Process no_feed = tool(plant, {"ctl", "move", "--tip=1,2,3"});
  EXPECT_EQ(no_feed.wait(milliseconds(20'000)), 2) << no_feed.said();
  ASSERT_NO_FATAL_FAILURE(expect_free());
  ASSERT_TRUE(plant.stream(small_program(20, 1500), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  })) << plant.station().message();
  ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.state == State::kLoaded; }));
  Process beside = move({1, 0, 0});
  EXPECT_EQ(beside.wait(milliseconds(20'000)), 4) << beside.said();
  EXPECT_NE(beside.said().find("with no program"), std::string::npos) << beside.said();
  EXPECT_EQ(plant.status().state, State::kLoaded) << "the program is as it was";
  EXPECT_EQ(plant.status().joints, joints);
}

TEST_F(SetUpMove, ThatIsInterruptedRestsOnItsWayAndFreesTheMachine) {
  ASSERT_NO_FATAL_FAILURE(start_in_ready());
  const Vector3 tip = pose().tip;
  Process slow = move({0, 0, 30}, "", "60");  // half a minute
  ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.state == State::kRunning; }))
      << slow.said();
  slow.send_signal(SIGINT);
  EXPECT_EQ(slow.wait(milliseconds(20'000)), 1) << slow.said();
  ASSERT_NO_FATAL_FAILURE(expect_free());
  const Vector3 moved = pose().tip - tip;
  EXPECT_GT(moved.z(), 0);
  EXPECT_LT(moved.z(), 25);
  EXPECT_LT(moved.head<2>().norm(), kThere_mm) << "straight";
}

}  // namespace
}  // namespace meridian::test
