// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "meridian/planner/feed_mark.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "property/planner/random_programs.hpp"
#include "support/cycle_world.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

/// Random programs through the real planner, port and cycle.
namespace meridian::test {

/// A random program that ends, with feeds at which it is over soon.
inline std::vector<ClBlock> draw_program(RandomPrograms& random, const MachineModel& machine,
                                         int length) {
  std::vector<ClBlock> blocks = random.program(machine, length);
  for (ClBlock& block : blocks) {
    if (block.feed_meaning == FeedMeaning::kTip) block.feed = std::max(block.feed, 20.0);
    if (block.feed_meaning == FeedMeaning::kInverseTime) block.feed = std::max(block.feed, 2.0);
  }
  end_program(blocks);
  return blocks;
}

/// One of two machines, cycle time 125 µs to 4 ms.
inline MachineModel draw_machine(RandomPrograms& random) {
  MachineModel machine = random.chance(0.5) ? bench_machine() : lai_machine();
  machine.cycle_ns = static_cast<std::int64_t>(random.log_uniform(125e3, 4e6));
  return machine;
}

/// A random machine with a random program for it.
struct Draw {
  explicit Draw(std::uint64_t seed) : random(seed), machine(draw_machine(random)) {
    blocks = draw_program(random, machine, 5);
  }
  /// With `model` and a cycle time of 125 µs to 4 ms.
  Draw(std::uint64_t seed, const MachineModel& model) : random(seed), machine(model) {
    machine.cycle_ns = static_cast<std::int64_t>(random.log_uniform(125e3, 4e6));
    blocks = draw_program(random, machine, 5);
  }

  /// Joints on the first block, so that nothing is to be approached; one program in ten approaches.
  [[nodiscard]] JointVector start() {
    const JointVector anywhere = random.start(machine);
    if (random.chance(0.1)) return anywhere;
    const ToolPose pose{to_vector(blocks.front().tip_mm), to_vector(blocks.front().axis)};
    JointVector q = solve(machine, machine.tool_length_mm, pose, 0, {}).q;
    wind_into_travel(machine, {}, q);
    return first_joint_outside_travel(machine, q, 0) < 0 ? q : anywhere;
  }
  RandomPrograms random;
  MachineModel machine;
  std::vector<ClBlock> blocks;
};

/// The machine on its way through one program: planned as far as the port takes it, cycle by cycle.
template <class Planner>
class PlannedRun {
 public:
  PlannedRun(const MachineModel& machine, const std::vector<ClBlock>& blocks,
             const JointVector& start, std::size_t blocks_before_start = ~std::size_t{0},
             const std::vector<FeedMark>* replayed = nullptr, bool is_stepped = false)
      : max_blocks(blocks_before_start),
        world(machine, start),
        planner_(world.machine),
        writer_(*world.port),
        blocks_(blocks) {
    is_started_ = world.enable();
    if constexpr (requires { planner_.replay_feed({}); }) {
      if (replayed != nullptr) planner_.replay_feed(*replayed);
    }
    if (machine.max_feed_override > 1 && replayed == nullptr) writer_.set_horizon(kFeedHorizon_s);
    planner_.begin(start, machine.tool_length_mm, world.state.epoch);
    // Blocks come as they are planned, not all at the begin.
    if constexpr (requires { planner_.look_no_further(); }) planner_.look_no_further();
    plan();
    is_started_ = is_started_ && !is_refused_ && world.run_until(State::kLoaded, 1);
    if (is_stepped) world.command(Verb::kSingleBlock, 1);
    if (is_started_) world.command(Verb::kStart);
  }

  /// False where the planner refused a block: the program is of no use then.
  [[nodiscard]] bool is_started() const { return is_started_; }
  [[nodiscard]] bool is_over() const { return world.now() == State::kReady || is_refused_; }

  const CycleRecord& run() {
    plan();
    return world.run();
  }
  /// A cycle in which the planner does not get to its work.
  const CycleRecord& run_unplanned() { return world.run(); }
  const CycleRecord& command(Verb verb, double argument = 0) {
    plan();
    return world.command(verb, argument);
  }

  [[nodiscard]] Planner& planner() { return planner_; }
  [[nodiscard]] MotionWriter& writer() { return writer_; }

  std::size_t max_blocks;  ///< that come between two cycles
  CycleWorld world;

 private:
  void plan() {
    const std::size_t last = std::min(blocks_.size(), next_ + std::min(max_blocks, blocks_.size()));
    while (next_ < last && !is_refused_) {
      const PlanResult result = planner_.plan(blocks_[next_], writer_);
      if (result.status == PlanStatus::kNoRoom) return;
      is_refused_ = result.status == PlanStatus::kRefused;
      next_ += is_refused_ ? 0 : 1;
    }
    if constexpr (requires { planner_.advance(writer_); }) {
      is_refused_ |= planner_.advance(writer_).status == PlanStatus::kRefused;
    }
  }

  Planner planner_;
  MotionWriter writer_;
  std::vector<ClBlock> blocks_;
  std::size_t next_ = 0;
  bool is_refused_ = false, is_started_ = false;
};
using ProgramRun = PlannedRun<RestToRestPlanner>;

/// Largest shares of the limits of joints and drives by differences of setpoints, rounding (8
/// ulp(q)/Tⁿ) taken off.
struct LimitShares {
  double v = 0, a = 0, j = 0;
  void take(const LimitShares& other) {
    v = std::max(v, other.v);
    a = std::max(a, other.a);
    j = std::max(j, other.j);
  }
};

/// Checks the setpoints from record `first` on; `is_fault` takes the FaultStop limits.
inline LimitShares shares_of_limits(const CycleWorld& world, std::size_t first, bool is_fault) {
  LimitShares out;
  const auto& r = world.records;
  const double dt = world.dt();
  for (std::size_t n = std::max<std::size_t>(first, 3); n < r.size(); ++n) {
    LimitedVector at[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const CycleRecord& record = r[n - 3 + k];
      at[k] = limited_of(world.machine, record.joints, record.setpoint.position);
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(limited_count(world.machine)); ++i) {
      const JointLimits& limits = limited_spec(world.machine, static_cast<int>(i)).limits;
      const double accel = is_fault ? limits.fault_acceleration : limits.acceleration;
      const double jerk = is_fault ? limits.fault_jerk : limits.jerk;
      const double q0 = at[0][i], q1 = at[1][i], q2 = at[2][i], q3 = at[3][i];
      const double max = std::max(std::abs(q0), std::abs(q3));
      const double ulp = 8 * (std::nextafter(max, 1e300) - max);
      out.take({(std::abs(q3 - q2) - ulp) / dt / limits.velocity,
                (std::abs((q3 - q2) - (q2 - q1)) - ulp) / (dt * dt) / accel,
                (std::abs((q3 - q2) - 2 * (q2 - q1) + (q1 - q0)) - ulp) / (dt * dt * dt) / jerk});
    }
  }
  return out;
}

}  // namespace meridian::test
