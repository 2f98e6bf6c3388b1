// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/program_summary.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace meridian::telemetry {
namespace {

constexpr double kPeriod_s = 1e-3;

/// The records of a machine, one after the other.
class Watched {
 public:
  CycleRecord record;  ///< what stays from one to the next
  double feed_override = 1, rapid_override = 1;
  bool is_dry_run = false;

  void run(State state, int cycles, bool is_moving = false) {
    record.state = state;
    record.setpoint.flags = is_moving ? kSetpointMoving : kSetpointEnabled;
    if (is_dry_run) record.setpoint.flags |= kSetpointDry;
    for (int n = 0; n < cycles; ++n) {
      ++record.setpoint.cycle;
      watch.see(record, feed_override, rapid_override);
    }
  }
  void move(State state, MotionKind motion, int cycles) {
    record.motion = motion;
    run(state, cycles, true);
  }
  void enter_block(std::uint64_t sequence) {
    record.sequence = sequence;
    record.setpoint.line = static_cast<std::uint32_t>(sequence + 10);
  }
  void advance_epoch() { ++record.setpoint.epoch; }

  ProgramWatch watch;
};

std::uint64_t cycles_of(const ProgramSummary& summary, ProgramPart part) {
  return summary.cycles[static_cast<std::size_t>(part)];
}

TEST(ProgramSummary, GivesEachPartItsTimeAndTheyAddUpToTheWhole) {
  Watched w;
  w.record.setpoint.cycle = 4000;
  w.run(State::kLoaded, 500);
  w.run(State::kApproaching, 7);  // an action before the first motion
  w.move(State::kApproaching, MotionKind::kApproach, 100);
  w.move(State::kRunning, MotionKind::kCut, 201);
  w.move(State::kHolding, MotionKind::kCut, 20);
  w.run(State::kHeld, 302);
  w.record.rate = 0;
  w.run(State::kRunning, 9);  // a dwell after a hold
  w.record.rate = 1;
  w.move(State::kRunning, MotionKind::kRapid, 403);
  w.move(State::kRunning, MotionKind::kPoleTurn, 30);
  w.move(State::kRunning, MotionKind::kRewind, 31);
  w.feed_override = w.record.rate = 0;
  w.run(State::kRunning, 40);
  w.feed_override = w.record.rate = 1;
  w.move(State::kStarving, MotionKind::kCut, 3);
  w.run(State::kStarved, 504);
  w.run(State::kStepping, 605);
  w.record.setpoint.cycle += 50;  // lost
  w.move(State::kRunning, MotionKind::kCut, 1);
  w.enter_block(7);
  w.run(State::kReady, 5);
  const auto summary = w.watch.take();
  ASSERT_TRUE(summary);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kApproach), 100U);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kCut), 201U + 20 + 3 + 51);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kRapid), 403U);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kTurn), 61U);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kRest), 7U + 9);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kHeld), 302U + 40);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kStarved), 504U);
  EXPECT_EQ(cycles_of(*summary, ProgramPart::kStepping), 605U);
  EXPECT_EQ(summary->whole, 2306U);
  EXPECT_EQ(std::accumulate(summary->cycles.begin(), summary->cycles.end(), std::uint64_t{0}),
            summary->whole);
  EXPECT_FALSE(w.watch.take()) << "reported once";
  EXPECT_EQ(describe(*summary, "part.apt", kPeriod_s, 1000),
            "program part.apt ran to its end: 7 blocks in 2.3 s (approach 0.1, cut 0.3, rapid 0.4, "
            "turns of the redundant joint 0.1, held 0.3, starved 0.5, single block 0.6)");
}

TEST(ProgramSummary, SaysInWhichBlockAProgramWasAbortedOrBehindWhich) {
  Watched w;
  for (const State rest : {State::kHeld, State::kStepping, State::kStarved}) {
    SCOPED_TRACE(static_cast<int>(rest));
    w.enter_block(0);
    w.move(State::kApproaching, MotionKind::kApproach, 100);
    w.enter_block(3);
    w.move(State::kRunning, MotionKind::kCut, 100);
    w.run(rest, 100);
    EXPECT_FALSE(w.watch.take()) << "it may go on";
    w.advance_epoch();
    w.run(State::kReady, 1);
    const auto summary = w.watch.take();
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->end, ProgramEnd::kAborted);
    EXPECT_EQ(summary->whole, 300U) << "the next program begins anew";
    const bool is_done = rest != State::kHeld;
    EXPECT_EQ(describe(*summary, "a", kPeriod_s, 90),
              is_done ? "program a was aborted after block 3, line 13: 4 blocks in 0.3 s"
                      : "program a was aborted in block 3, line 13: 3 blocks in 0.3 s");
  }
}

TEST(ProgramSummary, NamesTheBlockInWhichTheFaultCameNotWhereTheCommandedPathRanOutTo) {
  Watched w;
  w.move(State::kApproaching, MotionKind::kApproach, 100);
  w.enter_block(5);
  w.move(State::kRunning, MotionKind::kCut, 100);
  w.enter_block(6);
  w.move(State::kFaultStop, MotionKind::kCut, 100);
  w.advance_epoch();
  w.run(State::kFault, 1);
  const auto summary = w.watch.take();
  ASSERT_TRUE(summary);
  EXPECT_EQ(describe(*summary, "a", kPeriod_s, 1000),
            "program a ended by a fault in block 5, line 15: 5 blocks in 0.3 s (approach 0.1, cut "
            "0.2)");
}

TEST(ProgramSummary, SaysOfADryRunThatItWasOneHoweverLittleRoomThereIs) {
  Watched w;
  for (const bool is_dry : {true, false}) {
    w.is_dry_run = is_dry;
    w.move(State::kApproaching, MotionKind::kApproach, 100);
    w.run(State::kReady, 1);
    const auto summary = w.watch.take();
    ASSERT_TRUE(summary);
    EXPECT_EQ(describe(*summary, "a", kPeriod_s, 0),
              is_dry ? "the program ran to its end (dry run): 0 blocks in 0.1 s"
                     : "the program ran to its end: 0 blocks in 0.1 s");
  }
}

TEST(ProgramSummary, ReportsAFaultAtRestThatNoRecordShowsTheStopOf) {
  Watched w;
  w.move(State::kApproaching, MotionKind::kApproach, 100);
  w.run(State::kHeld, 1);
  w.advance_epoch();
  w.run(State::kFault, 1);
  const auto summary = w.watch.take();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, ProgramEnd::kFault);
}

TEST(ProgramSummary, ReportsNothingOfAMachineThatIsJoggedHomedOrFaultsWithoutAProgram) {
  Watched w;
  for (const State state : {State::kEnabling, State::kReady, State::kJogging, State::kHoming,
                            State::kAborting, State::kReady, State::kLoaded, State::kDisabling,
                            State::kOff, State::kFaultStop, State::kFault, State::kOff}) {
    w.run(state, 10);
  }
  EXPECT_FALSE(w.watch.take());
}

TEST(ProgramSummary, LeavesOutNameAndTimesWhereThereIsNoRoomForThem) {
  ProgramSummary summary;
  summary.cycles[0] = summary.whole = 100;
  summary.blocks = 2;
  const std::string name(30, 'x');
  const std::string all = describe(summary, name, kPeriod_s, 1000);
  const std::string without_name = "the program ran to its end: 2 blocks in 0.1 s (approach 0.1)";
  EXPECT_EQ(describe(summary, name, kPeriod_s, all.size()), all);
  EXPECT_EQ(describe(summary, name, kPeriod_s, all.size() - 1), without_name);
  EXPECT_EQ(describe(summary, name, kPeriod_s, without_name.size() - 1).find('('),
            std::string::npos);
  EXPECT_EQ(describe(summary, name, kPeriod_s, 0), "the program ran to its end: 2 blocks in 0.1 s");
}

}  // namespace
}  // namespace meridian::telemetry
