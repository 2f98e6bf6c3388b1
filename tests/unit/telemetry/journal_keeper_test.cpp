// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/journal_keeper.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace meridian::telemetry {
namespace {

/// The events of a program, told to a keeper that is asked every 10 ms.
class Kept {
 public:
  void tell(EventCode code, std::uint64_t a = 0, std::uint64_t b = 0) {
    keeper_.see({.code = code, .a = a, .b = b}, code == EventCode::kAlarm ? "a fault" : "");
  }
  void set_dry_run(bool is_dry_run) { keeper_.set_dry_run(is_dry_run); }
  void enter(State state) { tell(EventCode::kStateChanged, static_cast<std::uint64_t>(state)); }
  void begin(std::uint64_t block) { tell(EventCode::kBlockStarted, block, block + 10); }
  void end(std::uint64_t block) { tell(EventCode::kBlockDone, block, block + 10); }
  void run_for(int milliseconds) {
    for (int t = 0; t < milliseconds; t += 10) {
      now_ns_ += 10'000'000;
      if (const auto entry = keeper_.due(owner, now_ns_, now_ns_)) entries.push_back(*entry);
    }
  }
  JournalKeeper::Owner owner{7, "cam", "part.apt", ""};
  std::vector<JournalEntry> entries;

 private:
  JournalKeeper keeper_;
  std::int64_t now_ns_ = 5'000'000'000;
};

TEST(JournalKeeper, NotesNothingWhereNoProgramRuns) {
  Kept kept;
  for (const State state : {State::kEnabling, State::kReady, State::kLoaded, State::kFault}) {
    kept.enter(state);
    kept.run_for(3000);
  }
  EXPECT_TRUE(kept.entries.empty()) << "what the service before left stays";
}

TEST(JournalKeeper, NotesABlockThatIsAtMostASecondOldWhileTheProgramRuns) {
  Kept kept;
  kept.begin(0);
  kept.enter(State::kApproaching);
  kept.enter(State::kRunning);
  for (std::uint64_t block = 0; block < 40; ++block) {  // 4 s
    kept.run_for(100);
    kept.end(block);
    kept.begin(block + 1);
    kept.run_for(10);
    ASSERT_FALSE(kept.entries.empty());
    EXPECT_LE(block + 1 - kept.entries.back().block, 10U) << "more than a second old";
  }
  EXPECT_LE(kept.entries.size(), 6U) << "a disk is not written to without end";
  EXPECT_EQ(kept.entries.back().reached, Reached::kBegun);
  EXPECT_STREQ(kept.entries.back().program.data(), "part.apt");
}

TEST(JournalKeeper, NotesNothingOfADryRun) {
  Kept kept;
  const auto cut = [&kept] {
    kept.begin(0);
    kept.enter(State::kApproaching);
    kept.enter(State::kRunning);
    kept.run_for(1500);
    kept.end(0);
    kept.enter(State::kReady);
    kept.run_for(1500);
  };
  kept.set_dry_run(true);
  cut();
  EXPECT_TRUE(kept.entries.empty()) << "nothing was cut: what was noted before stays";
  kept.set_dry_run(false);
  cut();
  EXPECT_FALSE(kept.entries.empty());
}

TEST(JournalKeeper, NotesRestsAtOnceAndWhoseProgramItWas) {
  Kept kept;
  kept.begin(0);
  kept.enter(State::kApproaching);
  kept.run_for(50);
  kept.begin(3);
  kept.enter(State::kRunning);
  kept.enter(State::kHolding);
  kept.enter(State::kHeld);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().line, 13U);
  EXPECT_EQ(kept.entries.back().state, State::kHeld);
  kept.enter(State::kRunning);
  kept.end(3);
  kept.enter(State::kStepping);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().state, State::kStepping);
  EXPECT_EQ(kept.entries.back().reached, Reached::kDone);
  kept.enter(State::kRunning);
  kept.tell(EventCode::kAlarm);
  kept.enter(State::kFaultStop);
  kept.enter(State::kFault);
  kept.owner = {8, "other", "next.apt", ""};  // who comes next is not whose program failed
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().reached, Reached::kDone);
  EXPECT_EQ(kept.entries.back().state, State::kFault);
  EXPECT_STREQ(kept.entries.back().alarm.data(), "a fault");
  EXPECT_STREQ(kept.entries.back().program.data(), "part.apt");
  const std::size_t count = kept.entries.size();
  kept.enter(State::kOff);
  kept.run_for(3000);
  EXPECT_EQ(kept.entries.size(), count) << "the program is over";
}

TEST(JournalKeeper, NamesTheBlockOfTheAlarmAndNotWhereTheCommandedPathRanOutTo) {
  Kept kept;
  for (int program = 0; program < 2; ++program) {
    kept.begin(0);
    kept.enter(State::kApproaching);
    kept.run_for(20);
    EXPECT_EQ(kept.entries.back().line, 10U) << "the next program begins with its own";
    kept.enter(State::kRunning);
    kept.begin(3);
    kept.tell(EventCode::kAlarm);
    kept.enter(State::kFaultStop);
    kept.end(3);
    kept.begin(4);
    kept.run_for(2000);
    kept.end(4);
    kept.tell(EventCode::kProgramEnd, 1);
    kept.enter(State::kFault);
    kept.run_for(20);
    EXPECT_EQ(kept.entries.back().block, 3U);
    EXPECT_EQ(kept.entries.back().line, 13U);
    EXPECT_EQ(kept.entries.back().reached, Reached::kBegun);
    EXPECT_EQ(kept.entries.back().state, State::kFault);
    kept.enter(State::kOff);
  }
}

TEST(JournalKeeper, NotesTheEndOfAProgram) {
  Kept kept;
  kept.begin(0);
  kept.enter(State::kApproaching);
  kept.run_for(20);
  kept.enter(State::kRunning);
  kept.end(0);
  kept.tell(EventCode::kProgramEnd, 1);
  kept.enter(State::kReady);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().reached, Reached::kEnd);
  EXPECT_EQ(kept.entries.back().alarm[0], '\0');
}

}  // namespace
}  // namespace meridian::telemetry
