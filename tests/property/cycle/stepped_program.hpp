// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "property/cycle/operated_run.hpp"
#include "property/planner/smooth_trace.hpp"

/// Smooth programs that are run block by block.
namespace meridian::test::single_block {

/// A smooth program that runs, single block being on from before its start.
struct Stepped : test::PlannedRun<SmoothPlanner> {
  template <class Job>
  explicit Stepped(const Job& job, std::size_t blocks_before_start = ~std::size_t{0})
      : PlannedRun(job.machine, job.blocks, job.start(), blocks_before_start, nullptr, true) {}
};

inline constexpr double kSamePosition = 1e-9;  // mm, rad; joints are of 1e3, times eps 2e-13
inline constexpr double kMaxSeconds = 400;

/// Blocks of 0.1 to `longest_mm` that bend, turn back and tilt, with feeds of 10 to 150 mm/s.
inline std::vector<ClBlock> winding_program(std::uint32_t seed, int blocks, double longest_mm) {
  RandomPrograms random(seed);
  std::vector<ClBlock> out;
  Vector3 tip(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-20, 20));
  double heading = random.uniform(-3, 3), tilt = 0.4, azimuth = random.uniform(-3, 3), feed = 50;
  for (int n = 0; n < blocks; ++n) {
    ClBlock block;
    block.sequence = out.size();
    block.line = static_cast<std::uint32_t>(2 * out.size() + 10);
    block.tip_mm = to_array(tip);
    block.axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                  std::cos(tilt)};
    block.feed = feed;
    block.feed_meaning = FeedMeaning::kTip;
    out.push_back(block);
    if (random.chance(0.2)) feed = random.log_uniform(10, 150);
    heading += random.chance(0.2) ? random.uniform(-3, 3) : random.uniform(-0.1, 0.1);
    if (tip.norm() > 80) heading = std::atan2(-tip.y(), -tip.x());
    const double length = random.log_uniform(0.1, longest_mm);
    tip += length * Vector3(std::cos(heading), std::sin(heading), random.uniform(-0.2, 0.2));
    tilt = std::clamp(tilt + random.uniform(-0.05, 0.05), 0.2, 0.7);
    azimuth += random.uniform(-0.05, 0.05);
  }
  end_program(out);
  return out;
}

struct Job {
  explicit Job(std::uint32_t seed, int length = 40, double longest_mm = 20)
      : machine(seed % 2 == 0 ? test::bench_machine() : test::lai_machine()),
        blocks(winding_program(seed, length, longest_mm)) {
    machine.transition = Transition::kSmooth;
    machine.starve_auto_resume_s = 100;
  }
  [[nodiscard]] JointVector start() const { return test::joints_of(machine, blocks[0]); }
  [[nodiscard]] std::uint64_t last() const { return blocks.size() - 2; }

  MachineModel machine;
  std::vector<ClBlock> blocks;
};

/// Where the machine rested, by block.
using Rests = std::map<std::uint64_t, JointVector>;

/// Rests after every block of the program; blocks in the order of their rests.
inline std::vector<std::uint64_t> step_through(Stepped& run, Rests& rests, int says_again = 0) {
  std::vector<std::uint64_t> order;
  int n = 0;
  for (double t = 0; t < kMaxSeconds && !run.is_over(); t += run.world.dt()) {
    if (run.world.now() == State::kStepping) {
      order.push_back(run.world.records.back().sequence);
      rests[order.back()] = run.world.records.back().joints;
      run.command(n++ % 2 == 0 ? Verb::kResume : Verb::kStart);
    } else if (says_again > 0 && run.world.records.size() % says_again == 0) {
      run.command(Verb::kSingleBlock, 1);
    } else {
      run.run();
    }
  }
  return order;
}

/// Every block but the first, which is where the program starts.
inline std::vector<std::uint64_t> every_block(const Job& job) {
  std::vector<std::uint64_t> out;
  for (std::uint64_t n = 1; n <= job.last(); ++n) out.push_back(n);
  return out;
}

inline void expect_same_position(const JointVector& a, const JointVector& b, std::uint64_t block) {
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], kSamePosition) << "block " << block;
}

/// The next end of a block ahead of a machine in mid-motion; its own walk over the port.
inline std::optional<std::uint64_t> next_end(Stepped& run, std::uint64_t after) {
  CycleWorld& world = run.world;
  if (world.reader.path() == nullptr) return std::nullopt;
  for (std::size_t i = 0;; ++i) {
    const PathPiece* path = world.port->paths.peek(i);
    if (path == nullptr) return std::nullopt;
    for (std::uint32_t k = 0; k < path->marks.count; ++k) {
      const BlockMark& mark = path->marks.at[k];
      if (i == 0 && mark.s < world.state.on_path.s - 1e-9) continue;
      if (path->sequence + mark.ahead >= after) return path->sequence + mark.ahead;
    }
  }
}

}  // namespace meridian::test::single_block
