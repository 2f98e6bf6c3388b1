// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

/// `meridian ctl probe` on a machine that runs, against a block in front of the simulated drives.
namespace meridian::test {
namespace {

constexpr double kBall_mm = 3, kAhead_mm = 8;

class SetUpProbe : public testing::Test {
 protected:
  /// A machine in Ready whose probe meets a block when its tip has gone kAhead_mm along +x.
  void start_in_front_of_a_block() {
    const MachineModel model = config::load_machine(plant.machine());
    JointVector home{};
    for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
    const ToolPose pose = forward(model, model.tool_length_mm, home);
    const Vector3 centre = pose.tip + kBall_mm * pose.axis;
    const std::string part = plant.folder() / "part.toml";
    char text[256];
    std::snprintf(text, sizeof text,
                  "length_mm = %.17g\nball_radius_mm = %g\n[[box]]\norigin_mm = [%.17g, %.17g, "
                  "%.17g]\nsize_mm = [50, 100, 100]\n",
                  model.tool_length_mm, kBall_mm, centre.x() + kBall_mm + kAhead_mm,
                  centre.y() - 50, centre.z() - 50);
    std::ofstream(part) << text;
    plant.start_service({"--service", service_file(plant)});
    (void)plant.status();
    plant.start_drives({"--probe", part});
    ASSERT_TRUE(plant.enable()) << plant.service().said();
    tip_x = tip().x();
  }
  [[nodiscard]] Vector3 tip() {
    const dds::Status& status = plant.status();
    return forward(config::load_machine(plant.machine()), status.tool_length_mm, status.joints).tip;
  }
  [[nodiscard]] Process probe(const std::string& distance_mm,
                              const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"ctl",       "probe",  "--toward=+x", "--distance",
                                   distance_mm, "--feed", "300"};
    words.insert(words.end(), more.begin(), more.end());
    return tool(plant, words);
  }
  /// The number behind `words` in what was said.
  [[nodiscard]] static double number_after(const std::string& words, const std::string& said) {
    const std::size_t at = said.find(words);
    EXPECT_NE(at, std::string::npos) << said;
    return at == std::string::npos ? -1 : std::stod(said.substr(at + words.size()));
  }
  void expect_ready() {
    EXPECT_TRUE(plant.runs_until([](const dds::Status& status) {
      return status.state == State::kReady && status.session == 0;
    })) << plant.standing();
  }

  Plant plant;
  double tip_x = 0;
};

TEST_F(SetUpProbe, ReportsItsContactNotesTheTouchAndGoesBack) {
  ASSERT_NO_FATAL_FAILURE(start_in_front_of_a_block());
  const std::string touches = plant.folder() / "touches.csv";
  Process found = probe(
      "20", {"--retract", "2", "--touches", touches, "--radius", "3", "--corner-radius", "3"});
  ASSERT_EQ(found.wait(milliseconds(30'000)), 0) << found.said();
  const std::string said = found.said();
  std::fputs(said.c_str(), stdout);
  const double at = number_after("contact at ", said);
  const double uncertainty = number_after("uncertainty ", said);
  EXPECT_GT(uncertainty, 0);
  EXPECT_LT(uncertainty, 0.1);
  EXPECT_NEAR(at, tip_x + kAhead_mm, uncertainty + 1e-4) << said;
  EXPECT_GT(number_after("stop distance ", said), 0);
  EXPECT_GT(number_after("overtravel ", said), 0);
  ASSERT_NO_FATAL_FAILURE(expect_ready());
  EXPECT_NEAR(tip().x(), at - 2, 1e-3);
  EXPECT_EQ(plant.status().contacts, 1U);
  EXPECT_EQ(plant.status().probe, ProbeInput::kFree);
  EXPECT_EQ(plant.status().alarm, Alarm::kNone);
  const std::string rows = read_text(touches);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 2) << rows;
}

TEST_F(SetUpProbe, DoesNotGoBackWhereSomebodyStoppedItMeanwhile) {
  ASSERT_NO_FATAL_FAILURE(start_in_front_of_a_block());
  Process held = probe("20", {"--retract", "2"});
  ASSERT_TRUE(plant.wait_for(State::kRunning, milliseconds(10'000))) << held.said();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume));
  EXPECT_EQ(held.wait(milliseconds(30'000)), 1) << held.said();
  EXPECT_NE(held.said().find("contact at "), std::string::npos) << held.said();
  EXPECT_NE(held.said().find("no retract"), std::string::npos) << held.said();
  ASSERT_NO_FATAL_FAILURE(expect_ready());
  EXPECT_GT(tip().x(), tip_x + kAhead_mm - 0.1) << "where it touched";
}

TEST_F(SetUpProbe, IsRefusedInContactAndLetOutOfIt) {
  ASSERT_NO_FATAL_FAILURE(start_in_front_of_a_block());
  Process found = probe("20");
  ASSERT_EQ(found.wait(milliseconds(30'000)), 0) << found.said();
  ASSERT_NO_FATAL_FAILURE(expect_ready());
  EXPECT_EQ(plant.status().probe, ProbeInput::kContact);
  Process again = probe("20");
  EXPECT_EQ(again.wait(milliseconds(20'000)), 4) << again.said();
  EXPECT_NE(again.said().find("in contact"), std::string::npos) << again.said();
  Process out = tool(plant, {"ctl", "jog", "tool-x", "-20", "--distance", "3"});
  EXPECT_EQ(out.wait(milliseconds(20'000)), 0) << out.said();
  ASSERT_NO_FATAL_FAILURE(expect_ready());
  EXPECT_TRUE(plant.runs_until([](const auto& s) { return s.probe == ProbeInput::kFree; }));
}

TEST_F(SetUpProbe, SaysThatThereIsNoContactWithinTheDistance) {
  ASSERT_NO_FATAL_FAILURE(start_in_front_of_a_block());
  Process vain = probe("4");
  EXPECT_EQ(vain.wait(milliseconds(30'000)), 1) << vain.said();
  EXPECT_NE(vain.said().find("no contact within"), std::string::npos) << vain.said();
  ASSERT_NO_FATAL_FAILURE(expect_ready());
  EXPECT_EQ(plant.status().alarm, Alarm::kNoContact);
  EXPECT_NEAR(tip().x(), tip_x + 4, 1e-6);
}

TEST_F(SetUpProbe, ContactWhileJoggingIsAFault) {
  ASSERT_NO_FATAL_FAILURE(start_in_front_of_a_block());
  Process jog = tool(plant, {"ctl", "jog", "tool-x", "20", "--distance", "15"});
  EXPECT_TRUE(plant.wait_for(State::kFault, milliseconds(20'000))) << plant.standing();
  EXPECT_EQ(plant.status().alarm, Alarm::kContact) << plant.standing();
  EXPECT_LT(tip().x(), tip_x + kAhead_mm + 2);
  (void)jog.wait(milliseconds(10'000));
}

TEST_F(SetUpProbe, IsReplayedBitForBitFromItsRecordedContact) {
  ASSERT_NO_FATAL_FAILURE(start_in_front_of_a_block());
  const MachineModel model = config::load_machine(plant.machine());
  const ToolPose from = forward(model, model.tool_length_mm, plant.status().joints);
  const std::string part = plant.folder() / "part.apt";
  std::ofstream program(part);
  program.precision(17);
  program << "UNITS/MM\nMULTAX/ON\nFEDRAT/300,MMPM\n";
  for (const double ahead : {0.0, 20.0}) {
    program << "GOTO/" << from.tip.x() + ahead << ',' << from.tip.y() << ',' << from.tip.z() << ','
            << from.axis.x() << ',' << from.axis.y() << ',' << from.axis.z() << '\n';
  }
  program << "FINI\n" << std::flush;
  Process found = probe("20");
  ASSERT_EQ(found.wait(milliseconds(30'000)), 0) << found.said();
  ASSERT_NO_FATAL_FAILURE(expect_ready());
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  const std::string events = plant.folder() / "recording.events.csv";
  const std::string replayed = plant.folder() / "replayed.csv";
  Process simulate({"meridian", "simulate", part, "--machine", plant.machine(), "--events", events,
                    "--transition", "exact_stop", "--record", replayed},
                   plant.folder() / "simulate.log");
  EXPECT_EQ(simulate.wait(milliseconds(60'000)), 1) << simulate.said();
  EXPECT_NE(simulate.said().find("STOPPED"), std::string::npos) << "by its contact, before its end";
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, replayed));
}

TEST_F(SetUpProbe, IsRefusedWhereTheDrivesReportNoProbe) {
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process none = probe("4");
  EXPECT_EQ(none.wait(milliseconds(20'000)), 4) << none.said();
  EXPECT_NE(none.said().find("no probe"), std::string::npos) << none.said();
}

}  // namespace
}  // namespace meridian::test
