// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "meridian/planner/rest_to_rest.hpp"
#include "property/planner/random_programs.hpp"
#include "support/heap_watch.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

TEST(RestToRest, PlansWithoutAHeapCall) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "sanitizers watch the heap themselves";
  const MachineModel model = test::lai_machine();
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
  EXPECT_GT(planned, 1000) << refused << " refused";
}

}  // namespace
}  // namespace meridian
