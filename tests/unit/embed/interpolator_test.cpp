// SPDX-License-Identifier: Apache-2.0
#include "meridian/interpolator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "support/heap_watch.hpp"
#include "support/machines.hpp"
#include "support/simulated_run.hpp"

namespace meridian {
namespace {

constexpr const char* kPart =
    "UNITS / MM\nMULTAX / ON\nFEDRAT / 1200, MMPM\n"
    "GOTO / 80, -40, 20, 0.2, 0, 0.979796\nGOTO / 95, -40, 20, 0.2, 0, 0.979796\n"
    "GOTO / 95, -25, 18, 0.1, 0.2, 0.974679\nGOTO / 90, -25, 18, 0, 0.2, 0.979796\n"
    "CIRCLE / 85, -25, 18, 0, 0, 1, 5\nGOTO / 80, -25, 18, 0, 0.2, 0.979796\n"
    "RAPID\nGOTO / 80, -25, 40, 0, 0, 1\nFINI\n";

[[nodiscard]] std::vector<ClBlock> blocks_of(const char* text) {
  std::vector<ClBlock> blocks;
  cl::ClReader reader(text, "part.apt");
  while (true) {
    const auto block = reader.next();
    EXPECT_TRUE(block.has_value()) << block.error().text();
    if (!block || !*block) return blocks;
    blocks.push_back(**block);
  }
}

[[nodiscard]] bool is_same(const Setpoint& a, const Setpoint& b) {
  return a.cycle == b.cycle && a.due_ns == b.due_ns && a.line == b.line && a.epoch == b.epoch &&
         a.flags == b.flags && std::memcmp(&a.position, &b.position, sizeof a.position) == 0 &&
         std::memcmp(&a.velocity, &b.velocity, sizeof a.velocity) == 0;
}

class Embedded : public ::testing::Test {
 protected:
  void push_part() {
    for (const ClBlock& block : blocks_of(kPart)) {
      const auto pushed = interpolator.push(block);
      ASSERT_TRUE(pushed.has_value()) << pushed.error();
    }
  }

  /// Runs while the machine runs, with ideal drives.
  [[nodiscard]] Status run(std::vector<Setpoint>& setpoints, std::size_t max_cycles = 100'000) {
    Status status = Status::kRunning;
    Setpoint setpoint;
    while (status == Status::kRunning && max_cycles-- > 0) {
      status = interpolator.update(feedback, setpoint);
      feedback = ideal_feedback(model, setpoint);
      setpoints.push_back(setpoint);
    }
    return status;
  }

  MachineModel model = test::lai_machine();
  Interpolator interpolator{model};
  Feedback feedback = ideal_feedback(model);
};

TEST_F(Embedded, GivesTheSetpointsOfASimulatedRunBitForBit) {
  push_part();
  interpolator.start();
  std::vector<Setpoint> setpoints;
  ASSERT_EQ(run(setpoints), Status::kDone);
  const auto simulated = test::run_simulation(kPart, model);
  ASSERT_GT(setpoints.size(), 1000U);
  const std::uint64_t first = setpoints.front().cycle;
  std::size_t compared = 0;
  for (const CycleRecord& record : simulated.records) {
    const std::uint64_t cycle = record.setpoint.cycle;
    if (cycle < first || cycle > setpoints.back().cycle) continue;
    ASSERT_TRUE(is_same(record.setpoint, setpoints[cycle - first])) << "cycle " << cycle;
    ++compared;
  }
  EXPECT_EQ(compared, setpoints.size());
}

TEST_F(Embedded, AllocatesNothingInUpdate) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "the heap is not watched under sanitizers";
  push_part();
  interpolator.start();
  Setpoint setpoint;
  const watch::HeapWatch heap;
  std::size_t cycles = 0;
  while (interpolator.update(feedback, setpoint) == Status::kRunning) {
    feedback = ideal_feedback(model, setpoint);
    ++cycles;
  }
  const watch::HeapCalls calls = heap.calls();
  EXPECT_EQ(calls, watch::HeapCalls{}) << watch::HeapWatch::callers(calls);
  EXPECT_GT(cycles, 1000U);
}

TEST_F(Embedded, RefusesABlockThatIsNotFiniteWithItsLineAndEveryOneAfterIt) {
  auto blocks = blocks_of(kPart);
  blocks[1].tip_mm[2] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(interpolator.push(blocks[0]).has_value());
  const auto bad = interpolator.push(blocks[1]);
  ASSERT_FALSE(bad.has_value());
  EXPECT_NE(bad.error().find("tip z is not a finite number"), std::string::npos) << bad.error();
  EXPECT_NE(bad.error().find("5"), std::string::npos) << bad.error();
  EXPECT_FALSE(interpolator.push(blocks[2]).has_value());
}

TEST_F(Embedded, RefusesABlockBeyondTravel) {
  auto blocks = blocks_of(kPart);
  blocks[0].tip_mm[0] = 1e5;
  EXPECT_FALSE(interpolator.push(blocks[0]).has_value());
}

TEST_F(Embedded, DoesNotMoveWithoutAProgram) {
  interpolator.start();
  std::vector<Setpoint> setpoints;
  EXPECT_EQ(run(setpoints, 100), Status::kReady);
  EXPECT_EQ(setpoints.back().position, ideal_feedback(model).position);
}

TEST_F(Embedded, FaultsWhereTheMachineStandsElsewhere) {
  push_part();
  interpolator.start();
  feedback.position[0] += 50;
  Setpoint setpoint;
  Status status = Status::kRunning;
  for (int i = 0; i < 10'000 && status != Status::kFault; ++i) {
    status = interpolator.update(feedback, setpoint);
    EXPECT_EQ(setpoint.velocity[1], 0);
  }
  EXPECT_EQ(status, Status::kFault);
  EXPECT_NE(interpolator.alarm(), Alarm::kNone);
}

TEST_F(Embedded, HoldsResumesAndAbortsOnThePath) {
  push_part();
  interpolator.start();
  std::vector<Setpoint> setpoints;
  ASSERT_EQ(run(setpoints, 800), Status::kRunning);
  interpolator.hold();
  ASSERT_EQ(run(setpoints), Status::kHeld);
  interpolator.resume();
  ASSERT_EQ(run(setpoints, 200), Status::kRunning);
  EXPECT_FALSE(interpolator.begin().has_value());
  interpolator.abort();
  ASSERT_EQ(run(setpoints), Status::kStopped);
  EXPECT_FALSE(interpolator.push(blocks_of(kPart).front()).has_value());
}

TEST_F(Embedded, RunsASecondProgramFromWhereTheFirstEnded) {
  std::vector<Setpoint> setpoints;
  push_part();
  interpolator.start();
  ASSERT_EQ(run(setpoints), Status::kDone);
  ASSERT_TRUE(interpolator.begin().has_value());
  push_part();
  interpolator.start();
  EXPECT_EQ(run(setpoints), Status::kDone);
}

}  // namespace
}  // namespace meridian
