// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>
#include <vector>

#include "integration/checked_part.hpp"
#include "integration/fault_part.hpp"
#include "integration/live_run.hpp"
#include "integration/plant.hpp"
#include "integration/witness.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::test {
namespace {

constexpr milliseconds kPatience{20'000};
constexpr std::size_t kMoment_cycles = 20;

/// The test is the tool changer of a machine that cuts a part with a change in its middle.
class ToolChange : public testing::Test {
 protected:
  void start(const std::string& text) {
    std::ofstream(file()) << text;
    const std::string tools = std::string(MERIDIAN_SOURCE_DIR) + "/deploy/tools.toml";
    plant.change_machine({{"clearance_mm = [0-9]+", "clearance_mm = 5"}});
    plant.start_service(
        {"--service", service_file(plant, "tools = \"" + tools + "\"\naction_timeout_s = 1.2\n")});
    plant.start_drives({"--no-actions"});
    ASSERT_TRUE(plant.enable()) << plant.service().said();
    station = std::make_unique<Process>(
        std::vector<std::string>{"meridian", "stream", file(), "--domain", plant.domain(),
                                 "--transition", "smooth", "--wait-end"},
        plant.folder() / "station.log");
  }
  [[nodiscard]] std::string file() const { return (plant.folder() / "part.cls").string(); }
  /// Waits until the machine asks for the tool, in whatever order it says so.
  void wait_for_question() {
    ASSERT_TRUE(eventually([&] { return asked.take(action); }, kPatience)) << plant.standing();
    EXPECT_EQ(action.kind, ActionKind::kToolChange);
    EXPECT_EQ(action.value, 2);
    ASSERT_TRUE(plant.wait_for(State::kRunning))
        << plant.standing();  // it waits, not Held any more
    (void)witness.take();
  }
  void answer(bool is_done) {
    ASSERT_NO_FATAL_FAILURE(expect_no_motion(kMoment_cycles));
    ASSERT_TRUE(
        answers.write({.id = action.id, .service_id = action.service_id, .is_done = is_done}));
  }
  /// Since the question, or since this was asked last, for `cycles` at least.
  void expect_no_motion(std::size_t cycles) {
    std::vector<Setpoint> seen;
    ASSERT_TRUE(eventually([&] {
      const auto more = witness.take();
      seen.insert(seen.end(), more.begin(), more.end());
      return seen.size() >= cycles;
    })) << plant.standing();
    for (const Setpoint& setpoint : seen) {
      ASSERT_EQ(setpoint.flags & kSetpointMoving, 0) << "cycle " << setpoint.cycle;
      ASSERT_EQ(setpoint.position, seen.front().position) << "cycle " << setpoint.cycle;
    }
  }
  void expect_held_by_failure() {
    ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
    EXPECT_TRUE(eventually([&] { return plant.status().alarm == Alarm::kActionFailed; }))
        << plant.standing();
    expect_no_motion(kMoment_cycles);
  }

  const Phase phase{"", Phase::Where::kTool};
  const FaultPart part{phase};
  Plant plant;
  Witness witness{plant.participant()};
  dds::Reader<dds::Action> asked{plant.participant()};
  dds::Writer<dds::ActionDone> answers{plant.participant()};
  dds::Action action;
  std::unique_ptr<Process> station;
};

TEST_F(ToolChange, ThatIsRefusedOrComesTooLateHoldsWithoutMotionUntilItIsDone) {
  ASSERT_NO_FATAL_FAILURE(start(part.text()));
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station->said();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_NO_FATAL_FAILURE(wait_for_question());
  ASSERT_NO_FATAL_FAILURE(answer(false));
  ASSERT_NO_FATAL_FAILURE(expect_held_by_failure());

  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume));
  ASSERT_NO_FATAL_FAILURE(wait_for_question());  // and nobody answers
  ASSERT_NO_FATAL_FAILURE(expect_held_by_failure());
  const std::uint64_t late = action.id;

  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kResume));
  ASSERT_NO_FATAL_FAILURE(wait_for_question());
  EXPECT_NE(action.id, late);
  const std::uint64_t wanted = std::exchange(action.id, late);
  ASSERT_NO_FATAL_FAILURE(answer(true));  // to the question before: it does not count
  ASSERT_NO_FATAL_FAILURE(expect_no_motion(100));
  EXPECT_EQ(plant.status().state, State::kRunning);
  action.id = wanted;
  ASSERT_NO_FATAL_FAILURE(answer(true));

  ASSERT_EQ(station->wait(kPatience), 0) << station->said() << plant.standing();
  EXPECT_EQ(plant.status().alarm, Alarm::kNone);
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
  PartCut whole{.recording = plant.recording()};
  end_at(whole, plant.status());
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(8000)), 0) << plant.service().said();
  const MachineModel model = config::load_machine(plant.machine());
  const ToolTable tools =
      config::load_tools(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/tools.toml");
  const LinesCut cut = check({model, tools, file(), part.motions}, whole);
  EXPECT_EQ(cut.first, part.motions[1]);
  EXPECT_EQ(cut.last, part.motions.back());
}

TEST_F(ToolChange, ToAToolThatIsInNoTableIsRefusedBeforeAnythingMoves) {
  std::string text = part.text();
  text.replace(text.find("LOADTL/2"), 8, "LOADTL/9");
  ASSERT_NO_FATAL_FAILURE(start(text));
  EXPECT_EQ(station->wait(kPatience), 3) << station->said();
  EXPECT_NE(station->said().find("tool 9"), std::string::npos) << station->said();
  EXPECT_EQ(plant.status().state, State::kReady);
  EXPECT_EQ(plant.status().session, 0U);
  for (const Setpoint& setpoint : witness.take()) {
    ASSERT_EQ(setpoint.flags & kSetpointMoving, 0) << "cycle " << setpoint.cycle;
  }
}

}  // namespace
}  // namespace meridian::test
