// SPDX-License-Identifier: Apache-2.0

/// What a stream does to the look past the pole: ways from rest to rest, stalls, blocks in front.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_stream {
namespace {

void number(std::vector<ClBlock>& blocks) {
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n].sequence = n;
  end_program(blocks);
}

/// Over the pole in one corner at rest, `behind` blocks behind it, leaning gently, none at the
/// pole.
std::vector<ClBlock> over(int behind, int ahead = 20) {
  std::vector<ClBlock> blocks;
  for (int n = -ahead; n <= behind; ++n) {
    const double lean = units::rad_from_deg(10.0 * std::clamp(n / 20.0, -1.0, 1.0));
    const int at = n < 0 ? -(-n % 20) : (n % 200 < 100 ? n % 200 : 200 - n % 200);
    blocks.push_back(leaning(std::abs(lean), lean < 0 ? 0 : units::rad_from_deg(180),
                             Vector3(at, n > 200 ? 0.01 * n : 0, 0)));
  }
  number(blocks);
  return blocks;
}

struct Outcome {
  SmoothTrace trace;
  std::vector<FeedMark> marks;
  std::size_t stuck_at = 0;  ///< block that never found room
};

/// As planner_thread: a block that finds no room is offered again, the machine runs meanwhile.
Outcome stream(const MachineModel& model, const std::vector<ClBlock>& blocks,
               const JointVector& start, Transition transition,
               const std::vector<FeedMark>* replayed = nullptr) {
  Outcome out;
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  PatientReader reader(*port);
  SmoothPlanner planner(model);
  if (replayed != nullptr) planner.replay_feed(*replayed);
  planner.begin(start, model.tool_length_mm, 0, {transition, 0, 0});
  for (std::size_t n = 0; n < blocks.size() && out.stuck_at == 0; ++n) {
    for (int tries = 0;; ++tries) {
      out.trace.last = planner.plan(blocks[n], writer);
      if (out.trace.last.status != PlanStatus::kNoRoom) break;
      reader.read(out.trace, true);
      if (tries > 3000) {
        out.stuck_at = n;
        break;
      }
    }
    for (FeedMark mark; planner.take_feed_mark(mark);) out.marks.push_back(mark);
    if (out.trace.last.status == PlanStatus::kRefused) break;
  }
  reader.read(out.trace, true);
  return out;
}

TEST(PoleStream, AWayFromRestToRestOverThePoleIsNotStuckHoweverManyBlocksAreBehind) {
  const MachineModel models[] = {bench_machine(), limited(fork_machine(), -200, 200)};
  for (const MachineModel& model : models) {
    for (const int ahead : {20, 2500}) {
      SCOPED_TRACE(testing::Message() << model.name << " ahead " << ahead);
      const auto blocks = over(3000, ahead);
      const Outcome out =
          stream(model, blocks, joints_of(model, blocks[0]), Transition::kExactStop);
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
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  PatientReader reader(*port);
  Trace trace;
  SmoothPlanner planner(model);
  planner.begin(start, model.tool_length_mm, 0, {Transition::kExactStop, 0, 0});
  for (const ClBlock& block : blocks) {
    for (int n = 0; n < 100 && planner.plan(block, writer).status == PlanStatus::kNoRoom; ++n)
      reader.read(trace, true);
  }
  std::vector<FeedMark> marks;
  for (int n = 0; n < 200; ++n) {  // as planner_thread where the queue is empty, a second later
    if (planner.look() > 0) planner.look_no_further();
    EXPECT_EQ(planner.advance(writer).status, PlanStatus::kOk);
    reader.read(trace, true);
    for (FeedMark mark; planner.take_feed_mark(mark);) marks.push_back(mark);
  }
  EXPECT_EQ(planner.look(), 0U);
  std::uint64_t last = 0;
  for (const TimePiece& time : trace.times) last = std::max(last, time.sequence);
  EXPECT_EQ(last, blocks.back().sequence);
  EXPECT_LT(marks.size(), 10U);
}

/// As LookAhead.BeginsOnTheWinding..., with `dwells` blocks in front that do not move.
TEST(PoleStream, LooksAtTheBeginOfAProgramBehindBlocksThatDoNotMove) {
  MachineModel model = limited(fork_machine(), -360, 360);
  model.unwind_policy = UnwindPolicy::kRefuse;
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
    number(blocks);
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      for (const int turn : {-1, 0}) {  // of C where it stands
        JointVector start = joints_of(model, blocks[static_cast<std::size_t>(dwells)]);
        start[free_joint(model)] += turn * 2 * 3.14159265358979323846;
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
  for (const double side : {-1.0, 1.0}) {
    for (std::size_t behind = 0; behind < 14; ++behind) {
      for (const bool advances : {false, true}) {
        SCOPED_TRACE(testing::Message()
                     << "side " << side << " behind " << behind << " advances " << advances);
        const auto blocks = over(60);
        MachineModel model = bench_machine();
        const int branch = solve_block(model, blocks[0], 0)[4] * side > 0 ? 0 : 1;
        const JointVector start = solve_block(model, blocks[0], branch);
        model.joints[4].limits.travel_min = units::rad_from_deg(side > 0 ? -5 : -60);
        model.joints[4].limits.travel_max = units::rad_from_deg(side > 0 ? 60 : 5);
        const auto port = std::make_unique<MotionPort>();
        MotionWriter writer(*port);
        PatientReader reader(*port);
        SmoothPlanner planner(model);
        planner.begin(start, model.tool_length_mm, 0, {Transition::kExactStop, 0, 0});
        planner.look_no_further();
        SmoothTrace live;
        std::vector<FeedMark> marks;
        int stalls = 0;
        for (std::size_t n = 0; n < blocks.size(); ++n) {
          for (int k = 0; k < 1000; ++k) {
            live.last = planner.plan(blocks[n], writer);
            if (live.last.status != PlanStatus::kNoRoom) break;
            reader.read(live, false);
          }
          if (n == 21 + behind) {
            for (; stalls < 5 && planner.look() > 0; ++stalls) {
              if (advances) (void)planner.advance(writer);
              planner.look_no_further();
              (void)planner.advance(writer);
            }
          }
          for (FeedMark mark; planner.take_feed_mark(mark);) marks.push_back(mark);
          if (live.last.status != PlanStatus::kOk) break;
        }
        reader.read(live, true);
        EXPECT_LE(stalls, 1) << "told more than once";
        FeedMark begin;
        begin.looked_at = 1;
        // What was looked at of the begin: nothing, one block is as little.
        marks.insert(marks.begin() + 1, begin);
        const Outcome again = stream(model, blocks, start, Transition::kExactStop, &marks);
        EXPECT_EQ(live.last.status, again.trace.last.status);
        EXPECT_EQ(live.last.reject.sequence, again.trace.last.reject.sequence);
        EXPECT_EQ(live.times.size(), again.trace.times.size());
      }
    }
  }
}

}  // namespace
}  // namespace meridian::test::pole_stream
