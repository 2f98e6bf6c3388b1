// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "integration/plant.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::test {
namespace {

using stream::Station;
using stream::StationState;

class Operator : public testing::Test {
 protected:
  void load(const std::vector<ClBlock>& blocks) {
    plant.start_service();
    plant.start_drives(drives);
    ASSERT_TRUE(plant.enable()) << plant.service().said();
    ASSERT_TRUE(plant.stream(blocks, [](const Station& station) {
      return station.state() == StationState::kComplete;
    })) << plant.station().message();
    ASSERT_TRUE(plant.wait_for(State::kLoaded));
  }
  void say(Verb verb, double argument = 0) { ASSERT_NO_FATAL_FAILURE(plant.must(verb, argument)); }
  /// Ends the service and reads what it recorded.
  std::vector<record::RecordingRow> rows() {
    plant.service().send_signal(SIGTERM);
    EXPECT_EQ(plant.service().wait(milliseconds(8000)), 0) << plant.service().said();
    const MachineModel model = config::load_machine(machine_file());
    auto reader = record::RecordingReader::open(plant.recording(), model);
    std::vector<record::RecordingRow> all;
    if (!reader) return all;
    record::RecordingRow row;
    for (;;) {
      const auto has_row = reader->next(row);
      if (!has_row || !*has_row) return all;
      all.push_back(row);
    }
  }
  Plant plant;
  std::vector<std::string> drives;  ///< command line
};

/// `blocks` with the spindle started in line 77.
[[nodiscard]] std::vector<ClBlock> with_spindle(std::vector<ClBlock> blocks) {
  ClBlock spindle;
  spindle.kind = BlockKind::kAuxiliary;
  spindle.action = ActionKind::kSpindleClockwise;
  spindle.value = 8000;
  spindle.line = 77;
  blocks.insert(blocks.begin() + 2, spindle);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].sequence = i;
  return blocks;
}

/// As with_spindle(), an optional stop in front of it and coolant behind it, in line 78.
[[nodiscard]] std::vector<ClBlock> with_optional_stop(const std::vector<ClBlock>& plain) {
  std::vector<ClBlock> blocks = with_spindle(plain);
  ClBlock coolant = blocks[2], stop;
  coolant.action = ActionKind::kCoolantFlood;
  coolant.line = 78;
  stop.kind = BlockKind::kOptionalStop;
  blocks.insert(blocks.begin() + 3, coolant);
  blocks.insert(blocks.begin() + 2, stop);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].sequence = i;
  return blocks;
}

[[nodiscard]] double speed_of(const record::RecordingRow& row) {
  double square = 0;
  for (const double v : row.velocity) square += v * v;
  return std::sqrt(square);
}

using Rows = std::vector<record::RecordingRow>;

/// Whether the program went at its full rate and an even speed in the ten cycles before `hold`:
/// then nothing but the hold slows it down.
[[nodiscard]] bool is_even_before(const Rows& rows, Rows::const_iterator hold) {
  constexpr int kCycles = 10;
  if (hold - rows.begin() <= kCycles) return false;
  for (int i = 1; i <= kCycles; ++i) {
    if (hold[-i].state != State::kRunning || hold[-i].rate != 1) return false;
    if (std::abs(speed_of(hold[-i]) / speed_of(hold[-1]) - 1) > 2e-3) return false;
  }
  return true;
}

TEST_F(Operator, HoldsWithinTwoCyclesAndResumesFromThatVeryPoint) {
  load(small_program(30, 800, 20));
  say(Verb::kStart);
  ASSERT_TRUE(plant.wait_for(State::kRunning));
  for (int i = 0; i < 4; ++i) {
    std::this_thread::sleep_for(milliseconds(700));
    say(Verb::kHold);
    ASSERT_TRUE(plant.wait_for(State::kHeld));
    EXPECT_TRUE(eventually([&] { return plant.status().stop_time_s > 0; }));
    say(Verb::kResume);
    ASSERT_TRUE(plant.wait_for(State::kRunning));
  }
  std::this_thread::sleep_for(milliseconds(200));
  const Rows recorded = rows();
  ASSERT_FALSE(recorded.empty());

  const auto is_in = [](State state) {
    return [state](const auto& r) { return r.state == state; };
  };
  int even = 0;
  for (auto hold = recorded.begin();;) {
    hold = std::find_if(hold, recorded.end(), is_in(State::kHolding));
    if (hold == recorded.end()) break;
    const auto held = std::find_if(hold, recorded.end(), is_in(State::kHeld));
    const auto resumed = std::find_if_not(held, recorded.end(), is_in(State::kHeld));
    ASSERT_NE(resumed, recorded.end());
    EXPECT_EQ(speed_of(*held), 0.0);
    EXPECT_EQ(resumed[-1].joints, held->joints) << "stands still while held";
    if (is_even_before(recorded, hold)) {
      ++even;
      std::printf("rate before, at and after the hold was seen: %.9f %.9f %.9f\n", hold[-1].rate,
                  hold[0].rate, hold[1].rate);
      EXPECT_LT(std::min(hold[0].rate, hold[1].rate), 1.0) << "slower in the second cycle at last";
    }
    hold = resumed;
  }
  EXPECT_GT(even, 0) << "no hold fell into even motion";
}

TEST_F(Operator, SetsTheOverrideAndJointLimitsWin) {
  load(small_program(12, 600, 20));
  say(Verb::kFeedOverride, 0.5);
  EXPECT_TRUE(eventually([&] { return plant.status().feed_override == 0.5; }));
  const auto too_much = plant.say(Verb::kFeedOverride, 7);
  ASSERT_TRUE(too_much);
  EXPECT_EQ(too_much->refusal, Refusal::kOutOfRange);
}

TEST_F(Operator, AbortsAProgramAndItsSessionWithIt) {
  load(small_program(40, 500));
  say(Verb::kStart);
  ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.service().said();
  say(Verb::kAbort);
  ASSERT_TRUE(plant.wait_for(State::kReady));
  EXPECT_TRUE(plant.stream_on([](const Station& s) { return s.is_over(); }, milliseconds(3000)));
  EXPECT_EQ(plant.station().credit().verdict, dds::Verdict::kAborted);
  EXPECT_TRUE(eventually([&] {
    return plant.status().message.find(" was aborted in block ") != std::string::npos;
  })) << plant.status().message;
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->refusal, Refusal::kNoProgram) << start->text;
}

TEST_F(Operator, WaitsForActionsAtRestBehindAnOptionalStopToo) {
  load(with_optional_stop(small_program(4, 3000)));
  say(Verb::kOptionalStop, 1);
  say(Verb::kStart);
  ASSERT_TRUE(plant.wait_for(State::kHeld));
  say(Verb::kResume);
  ASSERT_TRUE(plant.stream_on([](const Station& s) { return s.is_over(); }, milliseconds(10000)))
      << plant.service().said();
  EXPECT_EQ(plant.station().state(), StationState::kRan) << plant.station().message();
  for (const char* line : {"77", "78"}) {
    EXPECT_NE(plant.service().said().find(std::string("waiting for the action of line ") + line),
              std::string::npos)
        << plant.service().said();
  }
}

TEST_F(Operator, SeesTheAlarmOfAFailedActionUntilTheProgramGoesOnOrIsOver) {
  drives = {"--no-actions"};
  dds::Reader<dds::Action> asked(plant.participant());
  dds::Writer<dds::ActionDone> answers(plant.participant());
  dds::Action action;
  const auto is_asked = [&] { return asked.take(action); };
  const auto answer = [&](bool is_done) {
    ASSERT_TRUE(
        answers.write({.id = action.id, .service_id = action.service_id, .is_done = is_done}));
  };
  const auto has_alarm = [&](Alarm alarm) {
    return eventually([&] { return plant.status().alarm == alarm; });
  };
  load(with_spindle(small_program(4, 3000)));
  say(Verb::kStart);
  ASSERT_TRUE(eventually(is_asked, milliseconds(8000))) << plant.service().said();
  answer(false);
  ASSERT_TRUE(plant.wait_for(State::kHeld));
  EXPECT_TRUE(has_alarm(Alarm::kActionFailed));
  say(Verb::kResume);
  ASSERT_TRUE(eventually(is_asked)) << "asked again after a resume";
  EXPECT_TRUE(has_alarm(Alarm::kNone)) << "it goes on";
  answer(false);
  ASSERT_TRUE(plant.wait_for(State::kHeld));
  EXPECT_TRUE(has_alarm(Alarm::kActionFailed));
  say(Verb::kAbort);
  ASSERT_TRUE(plant.wait_for(State::kReady));
  EXPECT_TRUE(has_alarm(Alarm::kNone)) << "the program is over";
}

TEST_F(Operator, IsRefusedWhoSawAnOldStatus) {
  load(small_program(4, 3000));
  const dds::Status old = plant.status();
  std::this_thread::sleep_for(milliseconds(700));
  const auto reply = plant.say_having_seen(Verb::kStart, old);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->is_accepted);
  EXPECT_EQ(reply->refusal, Refusal::kStale) << reply->text;
}

}  // namespace
}  // namespace meridian::test
