// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/journal_keeper.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace meridian::telemetry {
namespace {

/// The events of a program, passed to a keeper that is polled every 10 ms.
class Kept {
 public:
  void emit(EventCode code, std::uint64_t a = 0, std::uint64_t b = 0) {
    keeper_.see({.code = code, .cycle = cycle_, .a = a, .b = b},
                code == EventCode::kAlarm ? "a fault" : "");
  }
  void set_dry_run(bool is_dry_run) { keeper_.set_dry_run(is_dry_run); }
  void set_move(bool is_move) { keeper_.set_move(is_move); }
  void enter(State state) { emit(EventCode::kStateChanged, static_cast<std::uint64_t>(state)); }
  void begin(std::uint64_t block) { emit(EventCode::kBlockStarted, block, block + 10); }
  void end(std::uint64_t block) { emit(EventCode::kBlockDone, block, block + 10); }
  void run_for(int milliseconds) {
    for (int t = 0; t < milliseconds; t += 10) {
      now_ns_ += 10'000'000;
      if (const auto entry = keeper_.due(owner, now_ns_, now_ns_))
        entries.push_back(position = *entry);
      if (const auto entry = keeper_.due_position(owner, now_ns_)) position = *entry;
    }
  }
  /// The drives have come so far; events from now on are of the cycle after that.
  void take(std::uint64_t cycle) { keeper_.see_taken(cycle); }
  void set_cycle(std::uint64_t cycle) { cycle_ = cycle; }
  JournalKeeper::Owner owner{7, "cam", "part.apt", ""};
  JournalEntry position;
  std::vector<JournalEntry> entries;

 private:
  JournalKeeper keeper_;
  std::uint64_t cycle_ = 0;
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

TEST(JournalKeeper, NotesNothingOfAMoveBetweenPrograms) {
  Kept kept;
  kept.begin(3);
  kept.enter(State::kApproaching);
  kept.enter(State::kRunning);
  kept.run_for(20);
  kept.enter(State::kReady);  // aborted
  kept.run_for(1500);
  const auto noted = kept.entries.size();
  kept.set_move(true);
  kept.owner = {8, "anna", "move", ""};
  kept.begin(0);
  kept.enter(State::kRunning);
  kept.run_for(1500);
  kept.end(1);
  kept.emit(EventCode::kProgramEnd, 2);
  kept.owner.session = 0;
  kept.enter(State::kReady);
  kept.run_for(1500);
  EXPECT_EQ(kept.entries.size(), noted);
  EXPECT_EQ(kept.position.line, 13U);
  EXPECT_STREQ(kept.position.program.data(), "part.apt");
  kept.set_move(false);
  kept.owner = {9, "cam", "part.apt", "", 0, 13};
  kept.begin(0);
  kept.enter(State::kApproaching);
  kept.run_for(20);
  EXPECT_GT(kept.entries.size(), noted);
  EXPECT_EQ(kept.entries.back().next_line, 13U) << "gone on with as if nothing had been";
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
  kept.emit(EventCode::kAlarm);
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
    kept.emit(EventCode::kAlarm);
    kept.enter(State::kFaultStop);
    kept.end(3);
    kept.begin(4);
    kept.run_for(2000);
    kept.end(4);
    kept.emit(EventCode::kProgramEnd, 1);
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
  kept.emit(EventCode::kProgramEnd, 1);
  kept.enter(State::kReady);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().reached, Reached::kEnd);
  EXPECT_EQ(kept.entries.back().alarm[0], '\0');
}

TEST(JournalKeeper, KeepsWhatIsCutWhileItsRecoveryIsInterruptedAgainAndAgain) {
  Kept kept;
  kept.begin(0);
  kept.enter(State::kApproaching);
  kept.enter(State::kRunning);
  kept.begin(190);  // line 200
  kept.end(190);
  kept.begin(191);
  kept.enter(State::kAborting);
  kept.enter(State::kReady);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().next_line, 201U);
  for (std::uint64_t session = 8; session < 13; ++session) {
    kept.owner.session = session;
    kept.owner.from_line = 201;
    kept.emit(EventCode::kBlockStarted, 0, 2);  // the tool, of line 2
    kept.enter(State::kApproaching);
    kept.run_for(20);
    EXPECT_EQ(kept.entries.back().next_line, 201U);
    EXPECT_TRUE(is_recovering(kept.entries.back()));
    if (session % 2 == 0) {
      kept.emit(EventCode::kBlockDone, 0, 2);
      kept.emit(EventCode::kBlockStarted, 1, 199);  // the approach
    }
    kept.emit(EventCode::kAlarm);
    kept.enter(State::kFaultStop);
    kept.enter(State::kFault);
    kept.run_for(20);
    EXPECT_EQ(kept.entries.back().next_line, 201U);
  }
  kept.owner.session = 20;
  kept.emit(EventCode::kBlockStarted, 0, 199);
  kept.enter(State::kApproaching);
  kept.enter(State::kRunning);
  kept.emit(EventCode::kBlockStarted, 1, 201);
  kept.emit(EventCode::kBlockDone, 1, 201);
  kept.owner.is_line_end = true;
  kept.run_for(20);
  EXPECT_EQ(kept.position.next_line, 202U);
  EXPECT_EQ(kept.position.reached, Reached::kLineDone);
}

TEST(JournalKeeper, BeginsAnewWithAnotherProgramAndWithTheSameFromItsBegin) {
  for (const bool is_other : {false, true}) {
    Kept kept;
    kept.begin(40);
    kept.enter(State::kApproaching);
    kept.enter(State::kReady);
    kept.run_for(20);
    ASSERT_EQ(kept.entries.back().next_line, 50U);
    kept.owner.session = 8;
    if (is_other) {
      kept.owner.program = "other.apt";
      kept.owner.from_line = 5;
    }
    kept.begin(0);
    kept.enter(State::kApproaching);
    kept.run_for(20);
    EXPECT_EQ(kept.entries.back().next_line, 10U);
    EXPECT_STREQ(kept.entries.back().dropped.data(), "part.apt, cut up to line 50");
  }
}

TEST(JournalKeeper, GoesOnWithTheSameFileUnderAnotherNameAndNotWithAnotherOfTheSame) {
  for (const std::uint64_t checksum : {11U, 12U}) {
    Kept kept;
    kept.owner.file_checksum = 11;
    kept.begin(40);
    kept.enter(State::kApproaching);
    kept.enter(State::kReady);
    kept.run_for(20);
    kept.owner = {8, "cam", checksum == 11 ? "copy.apt" : "part.apt", ""};
    kept.owner.file_checksum = checksum;
    kept.owner.from_line = 20;
    kept.emit(EventCode::kBlockStarted, 0, 2);
    kept.enter(State::kApproaching);
    kept.run_for(20);
    EXPECT_EQ(kept.entries.back().next_line, checksum == 11 ? 50U : 0U);
  }
}

TEST(JournalKeeper, CountsWhatTheDrivesHaveTakenAndNothingElse) {
  Kept kept;
  kept.take(100);
  kept.set_cycle(100);
  kept.begin(0);
  kept.enter(State::kApproaching);
  kept.enter(State::kRunning);
  kept.set_cycle(150);
  kept.end(0);
  kept.begin(1);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().line, 10U) << "the drives are in cycle 100";
  kept.take(149);
  kept.run_for(1500);
  EXPECT_EQ(kept.position.line, 10U);
  kept.take(150);
  kept.run_for(20);
  EXPECT_EQ(kept.position.line, 11U);
  kept.set_cycle(160);
  kept.end(1);
  kept.begin(2);
  kept.emit(EventCode::kAlarm);
  kept.enter(State::kFaultStop);
  kept.enter(State::kFault);
  kept.run_for(20);
  EXPECT_EQ(kept.entries.back().next_line, 11U) << "drives died in cycle 150";
}

}  // namespace
}  // namespace meridian::telemetry
