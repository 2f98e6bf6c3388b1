// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "meridian/planner/rest_to_rest.hpp"
#include "property/planner/feed_paths.hpp"
#include "property/planner/random_programs.hpp"
#include "support/heap_watch.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

class RestToRestHeap : public testing::TestWithParam<MachineModel (*)()> {};

TEST_P(RestToRestHeap, PlansWithoutAHeapCall) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "sanitizers watch the heap themselves";
  const MachineModel model = GetParam()();
  RestToRestPlanner planner(model);
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  MotionReader reader(*port);
  int planned = 0, refused = 0;
  watch::HeapCalls calls;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    test::RandomPrograms draw(seed);
    const auto blocks = draw.program(model, 5);
    const JointVector start = draw.start(model);
    const watch::HeapWatch heap;
    planner.begin(start, model.tool_length_mm, 0);
    for (const ClBlock& block : blocks) {
      const PlanStatus status = planner.plan(block, writer).status;
      ++(status == PlanStatus::kOk ? planned : refused);
      while (reader.advance() != nullptr) {
      }
    }
    calls.allocations += heap.calls().allocations;
    calls.frees += heap.calls().frees;
  }
  EXPECT_EQ(calls, watch::HeapCalls{}) << calls.allocations << " allocations";
  EXPECT_GT(planned, 500) << refused << " refused";
}

INSTANTIATE_TEST_SUITE_P(Machines, RestToRestHeap,
                         testing::Values(&test::lai_machine, &test::hybrid_machine),
                         [](const auto& of) { return of.index == 0 ? "Plain" : "Stage"; });

TEST(RollingFeed, PlansWithoutAHeapCall) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "sanitizers watch the heap themselves";
  watch::HeapCalls calls;
  std::int64_t windows = 0;
  for (const double failing : {0.0, 0.5}) {
    FeedSettings settings;
    settings.failing_share = failing;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      test::RandomPrograms draw(seed);
      const test::FeedPath path = test::draw_path(test::lai_machine(), draw);
      RollingFeed planner(path.model, settings);
      const watch::HeapWatch heap;
      planner.begin(path.start, path.branch, path.model.tool_length_mm);
      for (const BandSpan& span : path.spans) {
        ASSERT_EQ(planner.push(span).kind, PathFault::Kind::kNone);
        while (planner.try_plan()) {
        }
      }
      ASSERT_EQ(planner.finish().kind, PathFault::Kind::kNone);
      while (planner.try_plan()) {
        if (seed % 2 == 0) planner.resume_from(planner.window().rest_cell);
      }
      calls.allocations += heap.calls().allocations;
      calls.frees += heap.calls().frees;
      windows += planner.count().windows;
    }
  }
  EXPECT_EQ(calls, watch::HeapCalls{}) << calls.allocations << " allocations";
  EXPECT_GT(windows, 40);
}

}  // namespace
}  // namespace meridian
