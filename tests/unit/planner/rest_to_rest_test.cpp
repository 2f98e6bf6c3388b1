// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/rest_to_rest.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "unit/planner/rest_to_rest_bench.hpp"

namespace meridian::test::rest_to_rest {
namespace {

TEST(RestToRest, PassesBlocksOfNoLength) {
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  bench.forget();
  for (std::uint64_t n = 1; n < 4; ++n) {
    ASSERT_EQ(bench.plan_and_take(cut(n, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  }
  EXPECT_TRUE(bench.times.empty());
}

TEST(RestToRest, MakesOneWindowFromRestOfEveryBlock) {
  Bench bench;
  for (std::uint64_t n = 0; n < 5; ++n) {
    ASSERT_EQ(bench.plan_and_take(cut(n, {10.0 * static_cast<double>(n), 0, 20}, tilted(0.3, 0.2)))
                  .status,
              PlanStatus::kOk);
  }
  std::uint32_t window = 0;
  for (std::size_t n = 0; n < bench.times.size(); ++n) {
    const TimePiece& piece = bench.times[n];
    EXPECT_TRUE(piece.is_from_rest);
    EXPECT_FALSE(piece.is_tail);
    if (n > 0 && piece.sequence != bench.times[n - 1].sequence) ++window;
    EXPECT_EQ(piece.window, window);
  }
  EXPECT_EQ(window, 4U);
}

TEST(RestToRest, BarriersRestInTheirOrder) {
  Bench bench(lai_machine(), ToolTable({{7, 95, 5}}));
  ClBlock dwell = block_of(BlockKind::kDwell, 0);
  dwell.value = 1.5;
  ClBlock tool = block_of(BlockKind::kTool, 2);
  tool.value = 7;
  std::vector<TimeKind> kinds;
  for (const ClBlock& block :
       {dwell, block_of(BlockKind::kAuxiliary, 1), tool, block_of(BlockKind::kStop, 3),
        block_of(BlockKind::kOptionalStop, 4), block_of(BlockKind::kEnd, 5)}) {
    ASSERT_EQ(bench.plan_and_take(block).status, PlanStatus::kOk);
    kinds.push_back(bench.times.back().kind);
    EXPECT_EQ(bench.times.back().sequence, block.sequence);
    EXPECT_EQ(bench.times.back().line, block.line);
  }
  EXPECT_EQ(kinds,
            (std::vector<TimeKind>{TimeKind::kDwell, TimeKind::kAction, TimeKind::kAction,
                                   TimeKind::kStop, TimeKind::kOptionalStop, TimeKind::kEnd}));
  EXPECT_EQ(bench.times.front().duration, 1.5);
}

TEST(RestToRest, StartsBehindAToolChangeFromTheSameJoints) {
  Bench bench(lai_machine(), ToolTable({{7, 95, 5}}));
  ASSERT_EQ(bench.plan(cut(0, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  const JointVector before = bench.planner.joints();
  ClBlock tool = block_of(BlockKind::kTool, 1);
  tool.value = 7;
  ASSERT_EQ(bench.plan(tool).status, PlanStatus::kOk);
  EXPECT_EQ(bench.planner.joints(), before);
  EXPECT_EQ(bench.planner.tool_length_mm(), 95);
  bench.forget();
  ASSERT_EQ(bench.plan_and_take(cut(2, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  EXPECT_EQ(bench.paths.front().tool_length_mm, 95);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(bench.paths.front().joints_begin[i], before[i], 1e-9);
  EXPECT_NEAR(bench.paths.front().length, 110 - 95, 1e-9);
}

TEST(RestToRest, PublishesNothingWithoutRoomAndTheSameLater) {
  Bench bench;
  Bench free;
  std::uint64_t n = 0;
  const auto next = [&n] { return cut(n, {n % 2 == 0 ? 0.0 : 5.0, 0, 20}, tilted(0.3, 0.2)); };
  while (bench.plan(next()).status == PlanStatus::kOk) {
    ASSERT_EQ(free.plan_and_take(next()).status, PlanStatus::kOk);
    ++n;
  }
  EXPECT_EQ(bench.plan(next()).status, PlanStatus::kNoRoom);
  const JointVector before = bench.planner.joints();
  EXPECT_EQ(bench.plan(next()).status, PlanStatus::kNoRoom);
  EXPECT_EQ(bench.planner.joints(), before);
  bench.take();
  ASSERT_EQ(bench.plan_and_take(next()).status, PlanStatus::kOk);
  ASSERT_EQ(free.plan_and_take(next()).status, PlanStatus::kOk);
  ASSERT_EQ(bench.times.size(), free.times.size());
  for (std::size_t k = 0; k < free.times.size(); ++k) {
    ASSERT_EQ(bench.times[k].s0, free.times[k].s0);
    ASSERT_EQ(bench.times[k].duration, free.times[k].duration);
    ASSERT_EQ(bench.times[k].path_index, free.times[k].path_index);
  }
}

TEST(RestToRest, KeepsInverseTimeAndTipFeed) {
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {0, 0, 20}, tilted(0.3, 0))).status, PlanStatus::kOk);
  bench.forget();
  ClBlock inverse = cut(1, {10, 0, 20}, tilted(0.35, 0.2));
  inverse.feed_meaning = FeedMeaning::kInverseTime;
  inverse.feed = 0.5;  // in two seconds
  ASSERT_EQ(bench.plan_and_take(inverse).status, PlanStatus::kOk);
  EXPECT_GT(bench.duration(), 2.0);
  EXPECT_LT(bench.duration(), 2.2);
  for (const TimePiece& time : bench.times) {
    EXPECT_NEAR(time.feed_mm_per_s, 5, 1e-9) << "10 mm in two seconds";
  }
  bench.forget();
  ASSERT_EQ(bench.plan_and_take(cut(2, {60, 0, 20}, tilted(0.35, 0.2), 20)).status,
            PlanStatus::kOk);
  EXPECT_GT(bench.duration(), 2.5);
  EXPECT_LT(bench.duration(), 2.55);
}

TEST(RestToRest, WastesLittleOfTheFastestMotionFromRestToRest) {
  // 100 mm along x by the joints alone: 300 mm/s, 3000 mm/s², 60000 mm/s³ give 0.4833 s; the
  // room for the rate filter takes some hundredths of acceleration and jerk.
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {0, 0, 20}, tilted(0, 0))).status, PlanStatus::kOk);
  bench.forget();
  ClBlock rapid = cut(1, to_vector({100, 0, 20}), tilted(0, 0));
  const ToolPose here = forward(bench.model, bench.model.tool_length_mm, bench.planner.joints());
  rapid.tip_mm = to_array(here.tip + Vector3(100 * std::cos(bench.planner.joints()[3]),
                                             100 * std::sin(bench.planner.joints()[3]), 0));
  rapid.kind = BlockKind::kRapid;
  ASSERT_EQ(bench.plan_and_take(rapid).status, PlanStatus::kOk);
  EXPECT_GT(bench.duration(), 0.4833);
  EXPECT_LT(bench.duration(), 0.4833 * 1.05);
}

TEST(RestToRest, EasesTheAxisOnlyOntoThePoleAndSaysSo) {
  Bench bench;
  ASSERT_EQ(bench.plan(cut(0, {0, 0, 20}, tilted(0.3, 0))).status, PlanStatus::kOk);
  const PlanResult relaxed = bench.plan(cut(1, {10, 0, 20}, tilted(5e-6, 2)));
  EXPECT_NEAR(relaxed.axis_deviation_rad, 5e-6, 1e-12);
  EXPECT_NEAR(bench.planner.joints()[4], 0, 1e-15);
  const PlanResult exact = bench.plan(cut(2, {20, 0, 20}, tilted(1e-5, 2)));
  EXPECT_EQ(exact.axis_deviation_rad, 0);
  EXPECT_NEAR(std::abs(bench.planner.joints()[4]), 1e-5, 1e-15);
}

TEST(RestToRest, GivesTheSameBitsForTheSameBlocks) {
  Bench a, b;
  for (std::uint64_t n = 0; n < 30; ++n) {
    const double x = static_cast<double>(n);
    const ClBlock block = cut(n, {7 * std::sin(x), 3 * x, 20}, tilted(0.02 * x, x));
    const auto ra = a.plan_and_take(block), rb = b.plan_and_take(block);
    ASSERT_EQ(ra.status, rb.status);
    if (ra.status != PlanStatus::kOk) break;
  }
  ASSERT_EQ(a.times.size(), b.times.size());
  ASSERT_GT(a.times.size(), 100U);
  for (std::size_t n = 0; n < a.times.size(); ++n) {
    EXPECT_EQ(a.times[n].s0, b.times[n].s0);
    EXPECT_EQ(a.times[n].v, b.times[n].v);
    EXPECT_EQ(a.times[n].j, b.times[n].j);
    EXPECT_EQ(a.times[n].duration, b.times[n].duration);
    EXPECT_EQ(a.times[n].stop_jerk, b.times[n].stop_jerk);
    EXPECT_EQ(a.paths[n].joints_end, b.paths[n].joints_end);
  }
}

}  // namespace
}  // namespace meridian::test::rest_to_rest
