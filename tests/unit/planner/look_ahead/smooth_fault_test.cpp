// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "unit/planner/look_ahead/ran_blocks.hpp"

/// Where a smooth run ends that cannot go on: it names the block, and rests ahead of it.
namespace meridian::test::smooth_fault {
namespace {

using ran_blocks::kBegin;
using ran_blocks::Ran;
using ran_blocks::Status;

constexpr double kTip_mm = 0.01;  // tolerance of the tip

/// The machine whose first joint may not pass where it is at `pose`.
MachineModel machine_that_ends_at(const ToolPose& pose) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = solve(model, model.tool_length_mm, pose, 0, {}).q[0];
  return model;
}

/// The slide that moves farthest from `from` to `at` may go no farther; which one.
int end_travel_at(const ToolPose& at, const ToolPose& from, MachineModel& model) {
  const JointVector begin = solve(model, model.tool_length_mm, from, 0, {}).q;
  const JointVector end = solve(model, model.tool_length_mm, at, 0, begin).q;
  int joint = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(end[i] - begin[i]) > std::abs(end[joint] - begin[joint])) joint = i;
  }
  JointLimits& limits = model.joints[joint].limits;
  (end[joint] > begin[joint] ? limits.travel_max : limits.travel_min) = end[joint];
  return joint;
}

/// Runs what is published, and what is planned yet, to the rest that the run ends in: the tip
/// there.
Vector3 run_out(Ran& one) {
  constexpr int kMaxPieces = 20000;
  one.reader.set_epoch(one.start.epoch);
  TimePiece last;
  PathPiece path;
  for (int n = 0; n < kMaxPieces; ++n) {
    one.status = one.run.publish(one.writer);
    const TimePiece* piece = one.reader.advance();
    if (piece != nullptr) {
      last = *piece;
      path = *one.reader.path();
    } else if (one.status == Status::kFailed) {
      break;
    }
  }
  EXPECT_EQ(one.status, Status::kFailed);
  EXPECT_FALSE(last.is_tail);
  const PathState rest = state_at(last, last.duration);
  EXPECT_NEAR(rest.ds, 0, 1e-6);
  return pose_at(path, rest.s).tip;
}

/// Not even as far as the travel reaches.
TEST(SmoothFault, MovesNothingWhereItsFirstBlockLeavesTravel) {
  for (const double inside_mm : {0.02, 3.0}) {
    SCOPED_TRACE(testing::Message() << inside_mm << " mm inside");
    MachineModel model = bench_machine();
    ToolPose at = kBegin;
    at.tip[0] += inside_mm;
    end_travel_at(at, kBegin, model);
    Ran one(model);
    for (int n = 0; n < 8 && !one.run.has_fault(); ++n) one.cut_straight(1, 50);
    if (!one.run.has_fault()) one.finish();
    ASSERT_TRUE(one.run.has_fault());
    EXPECT_EQ(one.run.faulty_block().sequence, 40U);
    one.reader.set_epoch(one.start.epoch);
    for (int n = 0; n < 50; ++n) {
      one.status = one.run.publish(one.writer);
      EXPECT_EQ(one.reader.advance(), nullptr) << "a piece of motion";
    }
    EXPECT_EQ(one.status, Status::kFailed);
  }
}

TEST(SmoothFault, EndsAheadOfABlockThatLeavesTravelAndNamesIt) {
  MachineModel model = bench_machine();
  ToolPose at = kBegin;
  at.tip[0] += 51;  // on the 26th block
  const int joint = end_travel_at(at, kBegin, model);
  Ran one(model);
  for (int n = 0; n < 150 && !one.run.has_fault(); ++n) one.cut_straight(1, 2);
  ASSERT_TRUE(one.run.has_fault());
  const Vector3 rest = run_out(one);
  EXPECT_EQ(one.run.fault().kind, PathFault::Kind::kTravel);
  EXPECT_EQ(one.run.faulty_block().joint, joint);
  EXPECT_EQ(one.run.faulty_block().sequence, 40U + 25);
  EXPECT_EQ(one.run.faulty_block().line, 140U + 25);
  EXPECT_NEAR((rest - kBegin.tip)[0], 50, kTip_mm) << "where the block before ends";
}

/// Reads a run that leaves travel, and keeps the tail of the window of the `keep_at`th piece: how
/// many pieces were read. What is behind that rest is published anew, or the run is over there.
int run_out_by_a_tail(Ran& one, int keep_at) {
  constexpr int kMaxRounds = 5000;
  one.reader.set_epoch(one.start.epoch);
  int pieces = 0;
  for (int n = 0; n < kMaxRounds; ++n) {
    one.status = one.run.publish(one.writer);
    const TimePiece* piece = one.reader.advance();
    if (piece == nullptr && one.status == Status::kFailed) break;
    if (piece == nullptr) continue;
    const bool is_kept = ++pieces == keep_at && !piece->is_tail && one.reader.is_tail_remembered();
    if (is_kept) one.reader.keep_tail(*one.reader.piece());
  }
  return pieces;
}

/// The fault lies in the middle of a long block, and so does the rest that windows share.
TEST(SmoothFault, IsOverInWhicheverTailTheMachineComesToRest) {
  for (const double reach_mm : {131.0, 150.0}) {
    MachineModel model = bench_machine();
    ToolPose at = kBegin;
    at.tip[0] += reach_mm;
    end_travel_at(at, kBegin, model);
    int pieces = 1;
    for (int keep_at = 1; keep_at <= pieces; keep_at += 9) {
      Ran one(model);
      for (int n = 0; n < 8 && !one.run.has_fault(); ++n) one.cut_straight(1, 60);
      ASSERT_TRUE(one.run.has_fault());
      pieces = std::max(pieces, run_out_by_a_tail(one, keep_at));
      EXPECT_EQ(one.status, Status::kFailed) << reach_mm << " mm, kept at piece " << keep_at;
    }
    EXPECT_GT(pieces, 20);
  }
}

/// Publishes what has room, and reads it, until there is no more.
void read_all(Ran& one) {
  while (one.status == Status::kNoRoom && one.reader.advance() != nullptr) {
    one.status = one.run.publish(one.writer);
  }
}

TEST(SmoothFault, EndsAheadOfTheFaultyBlockAlsoBehindALongerRun) {
  MachineModel model = bench_machine();
  ToolPose at = kBegin;
  at.tip[0] += 17;  // on the ninth block, behind the begin of a span
  end_travel_at(at, kBegin, model);
  Ran one(model);
  one.reader.set_epoch(one.start.epoch);
  constexpr int kShort = 120;
  for (int n = 0; n < 2 * kShort; ++n) {
    one.cut_straight(1, n < kShort ? -0.5 : 0.5);
    read_all(one);
  }
  one.finish();
  read_all(one);
  ASSERT_EQ(one.status, Status::kDone);
  one.start.joints = one.run.joints();
  one.start.path_index = one.run.next_path_index();
  one.start.window = one.run.next_window();
  one.begin();
  for (int n = 0; n < 150 && !one.run.has_fault(); ++n) {
    one.cut_straight(1, 2);
    read_all(one);
  }
  ASSERT_TRUE(one.run.has_fault());
  EXPECT_EQ(one.run.faulty_block().sequence, 40U + 2 * kShort + 8);
  EXPECT_NEAR((run_out(one) - kBegin.tip)[0], 16, kTip_mm) << "where the block before ends";
}

TEST(SmoothFault, NamesTheBlockThatLeavesTravelAmongShortOnes) {
  for (const int wanted : {28, 29, 30, 31, 32, 33}) {
    MachineModel model = bench_machine();
    ToolPose at = kBegin;
    at.tip[0] += 48.05 + 0.1 * wanted;  // in the middle of the short block
    model.joints[0].limits.travel_max = solve(model, model.tool_length_mm, at, 0, {}).q[0];
    Ran one(model);
    one.cut_straight(24, 2);
    one.cut_straight(100, 0.1);
    for (int n = 0; n < 150 && !one.run.has_fault(); ++n) one.cut_straight(1, 2);
    ASSERT_TRUE(one.run.has_fault());
    EXPECT_EQ(one.run.faulty_block().sequence, static_cast<std::uint64_t>(40 + 24 + wanted));
    EXPECT_EQ(one.run.faulty_block().line, static_cast<std::uint32_t>(140 + 24 + wanted));
  }
}

/// A span has one end of a block, or none: where it has one, the fault may lie ahead of it or not.
/// The end of a long block is not known yet where the fault is found near its begin.
TEST(SmoothFault, NamesTheBlockThatLeavesTravelAmongLongOnes) {
  for (const double length : {6.0, 10.0, 40.0}) {
    for (const int wanted : {1, 2, 3}) {
      for (const double share : {0.0005, 0.01, 0.03, 0.1, 0.5, 0.9, 0.99}) {
        ToolPose at = kBegin;
        at.tip[0] += length * (wanted + share);
        Ran one(machine_that_ends_at(at));
        for (int n = 0; n < 60 && !one.run.has_fault(); ++n) one.cut_straight(1, length);
        ASSERT_TRUE(one.run.has_fault());
        EXPECT_EQ(one.run.faulty_block().sequence, static_cast<std::uint64_t>(40 + wanted))
            << length << " mm, at " << share;
        EXPECT_EQ(one.run.faulty_block().line, static_cast<std::uint32_t>(140 + wanted));
        // At the end of the block before, or where the rest of what was published lies farther.
        const double rest = (run_out(one) - kBegin.tip)[0];
        EXPECT_GT(rest, length * wanted - kTip_mm);
        EXPECT_LE(rest, length * (wanted + share));
      }
    }
  }
}

/// The step of the samples does not matter.
TEST(SmoothFault, NamesTheBlockThatLeavesTravelWithinAMicrometreOfItsEnd) {
  for (const double length : {2.0, 2.4, 11.3}) {
    for (const int wanted : {2, 3, 4}) {
      for (const double beyond : {-0.001, 0.001}) {
        ToolPose at = kBegin;
        at.tip[0] += length * wanted + beyond;
        Ran one(machine_that_ends_at(at));
        for (int n = 0; n < 100 && !one.run.has_fault(); ++n) one.cut_straight(1, length, 200);
        ASSERT_TRUE(one.run.has_fault());
        const int block = beyond < 0 ? wanted - 1 : wanted;
        EXPECT_EQ(one.run.faulty_block().sequence, static_cast<std::uint64_t>(40 + block))
            << length << " mm, end of " << wanted << " and " << beyond;
      }
    }
  }
}

/// The axis at `x` of a path through the pole.
ToolPose pole_pose(double x) { return {Vector3(x, 0, 0), Vector3(0, 0.004 * x, 1).normalized()}; }

/// C may not turn by a half and the tilt may not turn over: nothing passes the pole.
MachineModel machine_without_pass() {
  MachineModel model = bench_machine();
  const int free = redundant_joint(model);
  model.joints[free].is_endless = false;
  model.joints[free].limits.travel_min = -2;
  model.joints[free].limits.travel_max = 0.5;
  model.joints[free == 4 ? 3 : 4].limits.travel_min = 0;
  return model;
}

/// Blocks of 2 mm through the pole, until a fault is known.
struct RanThroughPole : Ran {
  explicit RanThroughPole(const MachineModel& m) : Ran(m, pole_pose(kFrom_mm)) {
    reader.set_epoch(start.epoch);
    for (int n = 1; n <= 120 && !run.has_fault(); ++n) {
      cut(pole_pose(kFrom_mm + kLength_mm * n));
      while (status == Status::kNoRoom && reader.advance() != nullptr) {
        status = run.publish(writer);
      }
    }
  }
  /// x where the block before the faulty one ends.
  [[nodiscard]] double last_good_end() const {
    return kFrom_mm + kLength_mm * (static_cast<double>(run.faulty_block().sequence) - 40);
  }

  static constexpr double kFrom_mm = -60, kLength_mm = 2;
};

TEST(SmoothFault, WhereNoRouteLeadsPastThePoleItNamesTheBlockThereAndRestsAhead) {
  const MachineModel model = machine_without_pass();
  RanThroughPole one(model);
  ASSERT_TRUE(one.run.has_fault());
  EXPECT_EQ(one.run.fault().kind, PathFault::Kind::kBranch);
  EXPECT_EQ(one.run.faulty_block().joint, redundant_joint(model));
  EXPECT_EQ(one.run.fault().value, 0) << "there is none that it may have";
  // Spans are held back from where a pass may begin.
  EXPECT_GE(one.last_good_end(), -kPoleReach_mm - 2);
  EXPECT_LT(one.last_good_end(), -kPoleReach_mm + 2);
  EXPECT_EQ(one.run.faulty_block().line, one.run.faulty_block().sequence + 100);
  EXPECT_NEAR(run_out(one)[0], one.last_good_end(), kTip_mm);
}

/// On spans that are no cells yet where it is found that nothing passes the pole.
TEST(SmoothFault, NamesATravelFaultAheadOfThePoleFirst) {
  MachineModel model = machine_without_pass();
  const int joint = end_travel_at(pole_pose(-23.5), pole_pose(RanThroughPole::kFrom_mm), model);
  RanThroughPole one(model);
  ASSERT_TRUE(one.run.has_fault());
  EXPECT_EQ(one.run.fault().kind, PathFault::Kind::kTravel);
  EXPECT_EQ(one.run.faulty_block().joint, joint);
  EXPECT_EQ(one.last_good_end(), -24);
  EXPECT_NEAR(run_out(one)[0], -24, kTip_mm);
  EXPECT_EQ(one.run.fault().kind, PathFault::Kind::kTravel);
}

}  // namespace
}  // namespace meridian::test::smooth_fault
