// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>

#include "integration/live_run.hpp"
#include "integration/set_up_plant.hpp"

/// Programs that are cut in a work frame that was set live.
namespace meridian::test {
namespace {

const std::string kAt = "4,-3,2.5,0.3,-0.2,7";

[[nodiscard]] std::string events_of(const Plant& plant) {
  return (plant.folder() / "recording.events.csv").string();
}

TEST(SetUpCut, InAFrameSetLiveIsThatOfAServiceThatWasStartedWithItBitForBit) {
  LiveRun framed;
  framed.simulate = {"--frame", kAt};
  {
    Plant plant;
    const std::string part = plant.folder() / "part.apt";
    write_cl_file(part, 12);
    plant.start_service({"--service", service_file(plant), "--frame", kAt});
    plant.start_drives();
    ASSERT_NO_FATAL_FAILURE(cut(plant, part));
    ASSERT_NO_FATAL_FAILURE(end_service(plant));
    ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulate_part(plant, part, framed)));
  }
  Plant plant;
  const std::string part = plant.folder() / "part.apt";
  write_cl_file(part, 12);
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  Process set = tool(plant, {"ctl", "frame", "set", "1", "--at", kAt});
  ASSERT_EQ(set.wait(kToolPatience), 0) << set.said();
  ASSERT_TRUE(plant.enable()) << plant.service().said();  // in Ready, beside the drives
  Process select = tool(plant, {"ctl", "frame", "select", "1"});
  ASSERT_EQ(select.wait(kToolPatience), 0) << select.said();
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulate_part(plant, part, framed)));

  // The recording says where the workpiece lay: for a replay, and for who checks it.
  const LiveRun bare;
  const std::string replayed = simulate_part(plant, part, bare, {"--events", events_of(plant)});
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, replayed));
  ASSERT_NO_FATAL_FAILURE(expect_checked(plant, part, bare));
  Process elsewhere({"meridian", "check", plant.recording(), part, "--machine", plant.machine(),
                     "--frame", "0,0,0", "--max-missing", "1000000"},
                    plant.folder() / "check.log");
  EXPECT_EQ(elsewhere.wait(milliseconds(60'000)), 1) << elsewhere.said();
}

TEST(SetUpCut, FollowsTheFrameFromProgramToProgram) {
  Plant plant;
  const std::string part = plant.folder() / "part.apt";
  write_cl_file(part, 6);
  SetUpOperator anna(plant, 100);
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  const JointVector first = plant.status().joints;
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 1, 10)).is_accepted);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSelect, 1)).is_accepted);
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  const JointVector second = plant.status().joints;
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSelect, 0)).is_accepted);
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  const JointVector third = plant.status().joints;
  double moved = 0, back = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    moved = std::max(moved, std::abs(second[i] - first[i]));
    back = std::max(back, std::abs(third[i] - first[i]));
  }
  EXPECT_GT(moved, 1) << "mm, of a frame that lies 10 mm farther";
  EXPECT_LT(back, 0.1) << "mm: feedback of drives at rest";
}

TEST(SetUpCut, GoesWithAProgramFromOneWorkOffsetToTheOther) {
  Plant plant;
  const std::string part = plant.folder() / "two_vices.nc";
  std::ofstream(part) << "%\nO1\nG21 G90 G94\nF2000\nG54\nG43.4 H1\n"
                         "G0 X5. Y5. Z20. B10. C0.\nG1 X9. B12.\nG55\nG0 X-5. Y5.\n"
                         "G1 X-1. B11.\nM30\n%\n";
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  SetUpOperator anna(plant, 100);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 1, 4)).is_accepted);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 2, 34)).is_accepted);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSelect, 1)).is_accepted);
  ASSERT_NO_FATAL_FAILURE(cut(plant, part));
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  LiveRun framed;
  framed.simulate = {"--frame", "4,0,0"};
  const std::vector<std::string> zeros = {"--work-zero", "1=4,0,0", "--work-zero", "2=34,0,0"};
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulate_part(plant, part, framed, zeros)));
}

}  // namespace
}  // namespace meridian::test
