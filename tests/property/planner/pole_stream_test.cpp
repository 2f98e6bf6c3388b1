// SPDX-License-Identifier: Apache-2.0

/// What a stream does to the look past the pole: ways from rest to rest, stalls, blocks in front.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "property/planner/block_stream.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_stream {
namespace {

/// Over the pole in one corner at rest, `behind` blocks behind it, leaning gently, none at the
/// pole.
std::vector<ClBlock> over(int after, int ahead = 20) {
  std::vector<ClBlock> blocks;
  for (int n = -ahead; n <= after; ++n) {
    const double lean = units::rad_from_deg(10.0 * std::clamp(n / 20.0, -1.0, 1.0));
    const int at = n < 0 ? -(-n % 20) : (n % 200 < 100 ? n % 200 : 200 - n % 200);
    blocks.push_back(leaning(std::abs(lean), lean < 0 ? 0 : units::rad_from_deg(180),
                             Vector3(at, n > 200 ? 0.01 * n : 0, 0)));
  }
  number_and_end(blocks);
  return blocks;
}

/// All of `blocks`, the machine runs meanwhile.
StreamOutcome stream_all(const MachineModel& model, const std::vector<ClBlock>& blocks,
                         const JointVector& start, Transition transition,
                         const std::vector<FeedMark>* replayed = nullptr) {
  BlockStream stream(model, start, transition, replayed);
  for (const ClBlock& block : blocks) {
    if (!stream.offer(block, true)) break;
  }
  return stream.end();
}

TEST(PoleStream, AWayFromRestToRestOverThePoleIsNotStuckHoweverManyBlocksAreBehind) {
  const MachineModel models[] = {bench_machine(), limited(fork_machine(), -200, 200)};
  for (const MachineModel& model : models) {
    for (const int ahead : {20, 2500}) {
      SCOPED_TRACE(testing::Message() << model.name << " ahead " << ahead);
      const auto blocks = over(3000, ahead);
      const StreamOutcome out =
          stream_all(model, blocks, joints_of(model, blocks[0]), Transition::kExactStop);
      EXPECT_EQ(out.stuck_at, 0U);
      EXPECT_EQ(out.trace.last.status, PlanStatus::kOk);
    }
  }
}

TEST(PoleStream, GoesOffThePoleAfterASecondWhereNoBlockIsBehind) {
  const MachineModel model = limited(fork_machine(), -200, 200);
  auto blocks = over(60);
  blocks.resize(22);  // the last leads off the pole
  const JointVector start = joints_of(model, blocks[0]);
  BlockStream stream(model, start, Transition::kExactStop);
  for (const ClBlock& block : blocks) EXPECT_TRUE(stream.offer(block, true));
  for (int n = 0; n < 200; ++n) {  // as planner_thread where the queue is empty, a second later
    if (stream.planner.look() > 0) stream.planner.look_no_further();
    EXPECT_EQ(stream.planner.advance(stream.writer).status, PlanStatus::kOk);
    stream.read(true);
  }
  EXPECT_EQ(stream.planner.look(), 0U);
  const StreamOutcome out = stream.end();
  std::uint64_t last = 0;
  for (const TimePiece& time : out.trace.times) last = std::max(last, time.sequence);
  EXPECT_EQ(last, blocks.back().sequence);
  EXPECT_LT(out.marks.size(), 10U);
}

/// As LookAhead.BeginsOnTheWinding..., with `dwells` blocks in front that do not move.
TEST(PoleStream, LooksAtTheBeginOfAProgramBehindBlocksThatDoNotMove) {
  MachineModel model = limited(fork_machine(), -360, 360);
  model.rewind_policy = RewindPolicy::kRefuse;
  for (const int dwells : {0, 5, 60, 120}) {
    SCOPED_TRACE(dwells);
    std::vector<ClBlock> blocks;
    for (int n = 0; n < dwells; ++n) {
      ClBlock dwell;
      dwell.kind = BlockKind::kDwell;
      dwell.value = 0.01;
      blocks.push_back(dwell);
    }
    for (int n = -1; n <= 108; ++n) {
      const double azimuth = n < 0 ? 0 : -units::rad_from_deg(5.0 * n);
      blocks.push_back(
          leaning(0.3, azimuth, {30 * std::cos(azimuth), 30 * std::sin(azimuth), n < 0 ? 1.0 : 0}));
    }
    number_and_end(blocks);
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      for (const int turn : {-1, 0}) {  // of C where it stands
        JointVector start = joints_of(model, blocks[static_cast<std::size_t>(dwells)]);
        start[redundant_joint(model)] += turn * 2 * 3.14159265358979323846;
        if (first_joint_outside_travel(model, start, 0) >= 0) continue;
        const SmoothTrace trace = plan_smooth(model, blocks, start, {transition, 0, 0}, true);
        EXPECT_EQ(trace.last.status, PlanStatus::kOk)
            << "turn " << turn << " block " << trace.last.reject.sequence;
      }
    }
  }
}

/// A stall `behind` blocks behind one that leads off the pole from rest to rest.
TEST(PoleStream, ReplaysAStallBehindAWayFromRestToRest) {
  int all_stalls = 0;
  for (const double side : {-1.0, 1.0}) {
    for (std::size_t after = 0; after < 14; ++after) {
      for (const bool advances : {false, true}) {
        SCOPED_TRACE(testing::Message()
                     << "side " << side << " behind " << after << " advances " << advances);
        const auto blocks = over(60);
        MachineModel model = bench_machine();
        const int branch = solve_block(model, blocks[0], 0)[4] * side > 0 ? 0 : 1;
        const JointVector start = solve_block(model, blocks[0], branch);
        model.joints[4].limits.travel_min = units::rad_from_deg(side > 0 ? -5 : -60);
        model.joints[4].limits.travel_max = units::rad_from_deg(side > 0 ? 60 : 5);
        BlockStream stalled(model, start, Transition::kExactStop);
        stalled.planner.look_no_further();
        int stalls = 0;
        for (std::size_t n = 0; n < blocks.size(); ++n) {
          const bool goes_on = stalled.offer(blocks[n]);
          if (n == 21 + after) {
            for (; stalls < 5 && stalled.planner.look() > 0; ++stalls) {
              if (advances) (void)stalled.planner.advance(stalled.writer);
              stalled.stall();
            }
          }
          if (!goes_on) break;
        }
        StreamOutcome live = stalled.end();
        EXPECT_EQ(live.stuck_at, 0U);
        EXPECT_LE(stalls, 1) << "told more than once";
        all_stalls += stalls;
        ASSERT_FALSE(live.marks.empty());
        FeedMark begin;
        begin.looked_at = 1;
        // What was looked at of the begin: nothing, one block is as little.
        live.marks.insert(live.marks.begin() + 1, begin);
        const StreamOutcome again =
            stream_all(model, blocks, start, Transition::kExactStop, &live.marks);
        EXPECT_TRUE(are_same(live.trace, again.trace));
      }
    }
  }
  EXPECT_GT(all_stalls, 0) << "nothing was replayed";
}

}  // namespace
}  // namespace meridian::test::pole_stream
