// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/tools_sum.hpp"

/// Tool tables of a machine that runs.
namespace meridian::test {
namespace {

/// A part that calls tool 2 first; without, it goes on with what is in the spindle.
void write_part(const std::string& path, bool calls_tool) {
  std::ofstream(path) << "PARTNO TOOLS\nUNITS/MM\n"
                      << (calls_tool ? "LOAD/TOOL,2\n" : "") << "FEDRAT/4000,MMPM\n"
                      << cl_text(small_program(8, 4000, 2)) << "FINI\n";
}

TEST(SetUpTools, SetLiveCutAsThoseOfAServiceThatWasStartedWithThemBitForBit) {
  const std::string shipped = std::string(MERIDIAN_SOURCE_DIR) + "/deploy/tools.toml";
  LiveRun filed;
  Plant plant;
  const std::string part = plant.folder() / "part.apt", saved = plant.folder() / "saved.toml";
  write_part(part, true);
  plant.start_service({"--service", service_file(plant, "tools = \"" + shipped + "\"\n")});
  plant.start_drives();
  Process set = tool(plant, {"ctl", "tool", "set", "2", "--length", "97.125", "--length-wear",
                             "-0.4", "--holder", "0,31.5,40,20"});
  ASSERT_EQ(set.wait(kToolPatience), 0) << set.said();
  Process save = tool(plant, {"ctl", "tool", "save", saved});
  ASSERT_EQ(save.wait(kToolPatience), 0) << save.said();
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  EXPECT_EQ(plant.status().tool, 2U);
  EXPECT_EQ(plant.status().tool_length_mm, 97.125 - 0.4);
  Process list = tool(plant, {"ctl", "tool", "list"});
  ASSERT_EQ(list.wait(kToolPatience), 0) << list.said();
  EXPECT_NE(list.said().find("*   2  --length 97.125 --radius 3 --length-wear -0.4 --holder "
                             "0,31.5,40,20\n"),
            std::string::npos)
      << list.said();
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  filed.simulate = {"--tools", saved};
  const std::string simulated = simulate_part(plant, part, filed);
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated));
  ASSERT_NO_FATAL_FAILURE(expect_checked(plant, part, filed));

  // The recording says which tools they were: for a replay, and for who checks it.
  const LiveRun bare;
  const std::string events = (plant.folder() / "recording.events.csv").string();
  ASSERT_NO_FATAL_FAILURE(
      expect_same(plant, simulate_part(plant, part, bare, {"--events", events})));
  ASSERT_NO_FATAL_FAILURE(expect_checked(plant, part, bare));

  Plant started;
  started.start_service({"--service", service_file(started, "tools = \"" + saved + "\"\n")});
  started.start_drives();
  ASSERT_NO_FATAL_FAILURE(cut(started, part));
  ASSERT_NO_FATAL_FAILURE(end_service(started));
  ASSERT_NO_FATAL_FAILURE(expect_same(started, simulated));
}

TEST(SetUpTools, MeasureTheToolInTheSpindleAnewAndSurviveTheService) {
  Plant plant;
  const std::string first = plant.folder() / "first.apt", second = plant.folder() / "second.apt";
  write_part(first, true);
  write_part(second, false);
  SetUpOperator anna(plant, 100);
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  ASSERT_TRUE(anna.ask(tools_of(95)).is_accepted);
  ASSERT_NO_FATAL_FAILURE(cut(plant, first));
  const dds::Status before = plant.status();
  ASSERT_EQ(before.tool_length_mm, 95);
  const dds::Reply reply = anna.ask(tools_of(96));
  ASSERT_TRUE(reply.is_accepted);
  EXPECT_NE(reply.text.find("tool 2, 96 mm long in the spindle"), std::string::npos) << reply.text;
  ASSERT_TRUE(
      plant.runs_until([](const dds::Status& status) { return status.tool_length_mm == 96; }));
  ASSERT_NO_FATAL_FAILURE(cut(plant, second));
  const dds::Status after = plant.status();
  const MachineModel model = config::load_machine(plant.machine());
  const Vector3 tip = forward(model, 95, before.joints).tip;
  EXPECT_LT((forward(model, 96, after.joints).tip - tip).norm(), 0.1) << "mm: drives at rest";
  EXPECT_GT((forward(model, 95, after.joints).tip - tip).norm(), 0.9) << "mm, of 1 mm of tool";
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  plant.start_service();
  EXPECT_EQ(reported_by(plant).tool_file, tools_of(96));
  EXPECT_EQ(plant.status().tools, stream::tools_sum(config::parse_tools(tools_of(96), "test")));
}

TEST(SetUpTools, AreThoseOfOneOfTwoOperatorsWhoSawTheSame) {
  Plant plant;
  SetUpOperator anna(plant, 100), bert(plant, 200);
  plant.start_service();
  for (int round = 1; round <= 5; ++round) {
    SCOPED_TRACE(round);
    const dds::Status seen = plant.status();
    anna.say(tools_of(100 + round), seen);
    bert.say(tools_of(200 + round), seen);
    const auto a = anna.answer(), b = bert.answer();
    ASSERT_TRUE(a && b);
    if (!a->is_accepted && !b->is_accepted) continue;  // the host was slow: both saw an old status
    ASSERT_NE(a->is_accepted, b->is_accepted) << a->text << "\n" << b->text;
    EXPECT_EQ((a->is_accepted ? b : a)->refusal, Refusal::kStale);
    EXPECT_EQ(reported_by(plant).tool_file, tools_of((a->is_accepted ? 100 : 200) + round));
  }
}

TEST(SetUpTools, StayAsTheyAreWhileAProgramIsThereOrTheMachineMoves) {
  Plant plant;
  SetUpOperator anna(plant, 100);
  const auto expect_refused = [&](Refusal why) {
    const std::uint64_t before = plant.status().tools;
    const dds::Reply reply = anna.ask(tools_of(120));
    EXPECT_FALSE(reply.is_accepted);
    EXPECT_EQ(reply.refusal, why) << reply.text;
    EXPECT_EQ(plant.status().tools, before);
  };
  expect_refused_beside_a_program(plant, expect_refused);
}

TEST(SetUpTools, RefuseAProgramThatWasCheckedWithOthers) {
  Plant plant;
  SetUpOperator anna(plant, 100);
  plant.start_service();
  const std::uint64_t old_sum = plant.status().tools;
  ASSERT_TRUE(anna.ask(tools_of(101)).is_accepted);
  ASSERT_TRUE(plant.runs_until([&](const dds::Status& status) { return status.tools != old_sum; }));
  SetUpStation station(plant);
  ASSERT_TRUE(station.is_connected());
  const dds::Credit stale = station.open(51, {.tools = old_sum});
  EXPECT_EQ(stale.verdict, dds::Verdict::kRefusedProgram);
  EXPECT_NE(stale.text.find("stale: "), std::string::npos) << stale.text;
  EXPECT_EQ(station.open(52, {.tools = plant.status().tools}).verdict, dds::Verdict::kGood);
}

}  // namespace
}  // namespace meridian::test
