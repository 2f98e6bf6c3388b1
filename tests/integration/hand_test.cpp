// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "integration/plant.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::test {
namespace {

using stream::Station;

/// The largest share of its acceleration limit that a joint uses in state Jogging, cycle by cycle.
[[nodiscard]] double largest_share(const std::string& recording, const MachineModel& model) {
  auto reader = record::RecordingReader::open(recording, model);
  double share = 0;
  std::vector<record::RecordingRow> last;
  for (record::RecordingRow row; reader;) {
    const auto has_row = reader->next(row);
    if (!has_row || !*has_row) break;
    if (!last.empty() && row.cycle != last.back().cycle + 1) last.clear();
    last.push_back(row);
    if (last.size() < 3 || row.state != State::kJogging) continue;
    last.erase(last.begin(), last.end() - 3);
    const double dt = 1e-9 * static_cast<double>(model.cycle_ns);
    const double a = (last[2].joints[0] - 2 * last[1].joints[0] + last[0].joints[0]) / (dt * dt);
    share = std::max(share, std::abs(a) / model.joints[0].limits.acceleration);
  }
  return share;
}

/// A machine whose drives do not know where they are, up to its first program.
TEST(ByHand, JogsLosesItsHandIsHomedRunsAProgramAndIsLetGoWhereTheServiceFallsSilent) {
  Plant plant;
  plant.start_service();
  plant.start_drives({"--unreferenced", "all"});
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  const auto ctl = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"meridian", "ctl"});
    words.insert(words.end(), {"--domain", plant.domain(), "--machine-name", "lai"});
    return Process(words, plant.folder() / "ctl.log");
  };

  {  // somebody jogs and dies
    const double from = plant.status().joints[0];
    Process hand = ctl({"jog", "b3", "20"});
    ASSERT_TRUE(plant.wait_for(State::kJogging)) << hand.said();
    ASSERT_TRUE(eventually([&] { return plant.status().joints[0] > from + 5; })) << hand.said();
    const auto second = plant.say(Verb::kJog, 1);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->refusal, Refusal::kWrongState) << second->text;
    hand.send_signal(SIGKILL);
    ASSERT_TRUE(plant.wait_for(State::kReady, milliseconds(2000))) << "nobody holds it";
  }
  {  // a distance, exactly
    const double from = plant.status().joints[0];
    Process hand = ctl({"jog", "b3", "-15", "--distance", "4"});
    EXPECT_EQ(hand.wait(milliseconds(8000)), 0) << hand.said();
    EXPECT_TRUE(eventually([&] { return std::abs(plant.status().joints[0] - from + 4) < 1e-9; }))
        << plant.status().joints[0] - from;
  }
  const std::vector<ClBlock> program = small_program(3, 3000);
  const auto is_complete = [](const Station& station) {
    return station.state() == stream::StationState::kComplete;
  };
  Process home = ctl({"home", "--wait", "Ready"});
  ASSERT_EQ(home.wait(milliseconds(20000)), 0) << home.said() << plant.service().said();
  EXPECT_EQ(plant.status().alarm, Alarm::kNone) << plant.status().message;
  EXPECT_TRUE(eventually([&] {
    const MachineModel model = config::load_machine(plant.machine());
    return std::abs(plant.status().joints[0] - model.joints[0].home) < 1e-3;
  })) << "the switch is at home: "
      << plant.status().joints[0];
  ASSERT_TRUE(plant.stream(program, is_complete)) << plant.station().message();
  ASSERT_TRUE(plant.wait_for(State::kLoaded));
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  EXPECT_TRUE(plant.stream_on([](const Station& s) { return s.is_over(); }, milliseconds(20000)));
  EXPECT_EQ(plant.station().state(), stream::StationState::kRan) << plant.station().message();

  {  // the service is stopped: the hand does not go on for nobody
    dds::Reader<dds::Jog> jogs(plant.participant());
    Process hand = ctl({"jog", "b3", "-5"});
    ASSERT_TRUE(plant.wait_for(State::kJogging)) << hand.said();
    plant.service().send_signal(SIGSTOP);
    EXPECT_EQ(hand.wait(milliseconds(8000)), 5) << hand.said();
    EXPECT_NE(hand.said().find("does not answer"), std::string::npos) << hand.said();
    dds::Jog last{.velocity = -1};
    EXPECT_TRUE(eventually([&] {
      while (jogs.take(last)) {
      }
      return last.velocity == 0;
    })) << "it let go, and did not leave that to the dead man's time";
    plant.service().send_signal(SIGCONT);
  }
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(8000)), 0) << plant.service().said();
  const double share =
      largest_share(plant.recording().string(), config::load_machine(plant.machine()));
  EXPECT_LE(share, 1 + 1e-6);
  EXPECT_GT(share, 0.01) << "it was recorded";
}

}  // namespace
}  // namespace meridian::test
