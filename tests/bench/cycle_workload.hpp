// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>

#include "bench/planned_path.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "meridian/rt/step.hpp"
#include "support/machines.hpp"

/// One workload for the benchmark that measures time and for the gate that counts instructions.
namespace meridian::bench {

/// The cycle of a machine that runs a program: drives follow at once, the clock never slips. When
/// the planned blocks are used up they are planned again, so that it can run for ever.
class RunningCycle {
 public:
  RunningCycle()
      : machine_(test::lai_machine()),
        planner_(machine_),
        port_(std::make_unique<MotionPort>()),
        writer_(*port_),
        reader_(*port_) {
    reader_.set_epoch(state_.epoch);
    in_.feedback.joint_mask = 31;
    in_.feedback.referenced_mask = 31;
    in_.session = 1;
    run();
    command(Verb::kEnable);
    for (int i = 0; i < 8; ++i) {
      run();
    }
    planner_.begin(in_.feedback.position, machine_.tool_length_mm, state_.epoch);
    plan();
    run();
    command(Verb::kStart);
    // Past the approach: what is measured is cutting.
    for (int i = 0; i < 120'000 && !(state_.state == State::kRunning && state_.sequence > 2); ++i) {
      run();
    }
  }

  /// One cycle; returns the bits of a joint.
  std::uint64_t run() noexcept {
    ++in_.cycle;
    in_.due_ns += machine_.cycle_ns;
    in_.now_ns = in_.due_ns;
    in_.feedback.arrival_ns = in_.due_ns;
    step(machine_, state_, reader_, in_, out_);
    in_.has_command = false;
    const bool is_enabled = (out_.record.setpoint.flags & kSetpointEnabled) != 0;
    in_.feedback.enabled_mask = is_enabled ? 31 : 0;
    in_.feedback.cycle_seen = in_.cycle;
    if (is_enabled) {
      in_.feedback.position = out_.record.setpoint.position;
    }
    std::uint64_t bits = 0;
    std::memcpy(&bits, &out_.record.setpoint.position[3], sizeof bits);
    return bits;
  }

  /// Planner thread's part: fills the port as far as it goes.
  void plan() {
    while (planner_.plan(block_on_path(next_block_), writer_).status == PlanStatus::kOk) {
      ++next_block_;
    }
  }

  [[nodiscard]] State state() const noexcept { return state_.state; }
  [[nodiscard]] bool needs_plan() const noexcept { return port_->times.size() < 4096; }
  [[nodiscard]] const CycleRecord& record() const noexcept { return out_.record; }

 private:
  void command(Verb verb) {
    in_.has_command = true;
    in_.command = {++request_, verb, 0};
    run();
  }

  MachineModel machine_;
  RestToRestPlanner planner_;
  std::unique_ptr<MotionPort> port_;
  MotionWriter writer_;
  MotionReader reader_;
  CycleState state_;
  CycleInputs in_;
  StepOutput out_;
  std::uint64_t request_ = 0, next_block_ = 0;
};

/// Runs `n` cycles of a machine that cuts; returns a checksum of the setpoints, 0 if it does not
/// cut any more. At most 20000: the port then holds the whole plan, and no planning is counted.
[[nodiscard]] inline std::uint64_t run_cycle(int n) {
  RunningCycle cycle;
  std::uint64_t sum = 0;
  for (int i = 0; i < n; ++i) {
    sum += cycle.run();
  }
  return cycle.state() == State::kRunning ? sum | 1U : 0;
}

}  // namespace meridian::bench
