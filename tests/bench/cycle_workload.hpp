// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

#include "bench/planned_path.hpp"
#include "meridian/cycle/step.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "support/dense_block.hpp"
#include "support/machines.hpp"

/// One workload for the benchmark that measures time and for the gate that counts instructions.
namespace meridian::bench {

/// The cycle of a machine with a planner: drives follow at once, the clock never slips.
template <class Planner>
class DrivenCycle {
 public:
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

  [[nodiscard]] State state() const noexcept { return state_.state; }
  [[nodiscard]] const CycleRecord& record() const noexcept { return out_.record; }

 protected:
  /// Enabled, and ready to plan from where it stands.
  explicit DrivenCycle(const MachineModel& machine) : machine_(machine), planner_(machine_) {
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
  }

  void command(Verb verb, double argument = 0) {
    in_.has_command = true;
    in_.command = {++request_, verb, argument};
    run();
  }

  MachineModel machine_;
  Planner planner_;
  std::unique_ptr<MotionPort> port_ = std::make_unique<MotionPort>();
  MotionWriter writer_{*port_};
  MotionReader reader_{*port_};
  CycleState state_;
  CycleInputs in_;
  StepOutput out_;
  std::uint64_t request_ = 0;
};

/// One that runs a program. When the planned blocks are used up they are planned again, so that it
/// can run for ever.
class RunningCycle : public DrivenCycle<RestToRestPlanner> {
 public:
  RunningCycle() : DrivenCycle(test::lai_machine()) {
    plan();
    run();
    command(Verb::kStart);
    // Past the approach: what is measured is cutting.
    for (int i = 0; i < 120'000 && !(state_.state == State::kRunning && state_.sequence > 2); ++i) {
      run();
    }
  }

  /// Planner thread's part: fills the port as far as it goes.
  void plan() {
    while (planner_.plan(block_on_path(next_block_), writer_).status == PlanStatus::kOk) {
      ++next_block_;
    }
  }
  [[nodiscard]] bool needs_plan() const noexcept { return port_->times.size() < 4096; }

 private:
  std::uint64_t next_block_ = 0;
};

/// The Lai machine where it runs on through blocks.
[[nodiscard]] inline MachineModel smooth_machine() {
  MachineModel machine = test::lai_machine();
  machine.transition = Transition::kSmooth;
  return machine;
}

/// One that cuts a block of 70 mm smoothly at its full rate, its axis turning, single block being
/// on: the end of the block is sought in every cycle and not in sight.
class SteppedCycle : public DrivenCycle<SmoothPlanner> {
 public:
  SteppedCycle() : DrivenCycle(smooth_machine()) {
    planner_.look_no_further();
    for (std::uint64_t n = 0; n < 3; ++n) {
      (void)planner_.plan(long_block(n), writer_);
      (void)planner_.advance(writer_);
    }
    run();
    command(Verb::kSingleBlock, 1);
    command(Verb::kStart);
    for (int i = 0; i < 120'000 && !is_at_feed(); ++i) {
      if (state_.state == State::kStepping) command(Verb::kResume);
      run();
      (void)planner_.advance(writer_);
    }
  }

  [[nodiscard]] bool is_at_feed() const noexcept {
    return state_.state == State::kRunning && state_.sequence == 1 && record().rate == 1;
  }

 private:
  [[nodiscard]] static ClBlock long_block(std::uint64_t n) {
    ClBlock block;
    block.kind = n < 2 ? BlockKind::kCut : BlockKind::kEnd;
    block.sequence = n;
    block.tip_mm = {n == 0 ? -35.0 : 35.0, 0, 0};
    const double tilt = n == 0 ? 0.2 : 0.25, azimuth = n == 0 ? 0.3 : 0.48;
    block.axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                  std::cos(tilt)};
    block.feed = 20;
    block.feed_meaning = FeedMeaning::kTip;
    return block;
  }
};

/// One that runs smoothly from window to window: each of them ends in a tail of some 80 pieces,
/// which the cycle that comes to it skips.
class WindowedCycle : public DrivenCycle<SmoothPlanner> {
 public:
  WindowedCycle() : DrivenCycle(smooth_machine()) {
    for (std::uint64_t n = 0; n <= kBlocks; ++n) {
      ClBlock block = test::dense_block(n, 0.3, 50);
      block.kind = n < kBlocks ? BlockKind::kCut : BlockKind::kEnd;
      (void)planner_.plan(block, writer_);
    }
    run();
    command(Verb::kStart);
    for (int i = 0; i < 20'000 && state_.state != State::kRunning; ++i) run();
  }

  /// Whether it is still cutting, has skipped at least `min` tails and run none.
  [[nodiscard]] bool has_skipped(std::uint32_t min) const noexcept {
    const auto begun = writer_.window_begun();
    return state_.state == State::kRunning && begun && begun->window > min &&
           !writer_.tail_entered();
  }

 private:
  static constexpr std::uint64_t kBlocks = 190;
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

/// The same of one that looks for the end of its block. At most 2500: then it is in sight.
[[nodiscard]] inline std::uint64_t run_stepped_cycle(int n) {
  SteppedCycle cycle;
  std::uint64_t sum = 0;
  for (int i = 0; i < n; ++i) {
    sum += cycle.run();
  }
  return cycle.is_at_feed() ? sum | 1U : 0;
}

/// Nothing; callgrind begins to count anew where it comes here (--dump-before).
[[gnu::noinline]] inline void begin_counted_call() { asm volatile("" ::: "memory"); }

/// Runs `n` cycles of a machine that cuts from window to window, each counted for itself; returns
/// a checksum, 0 if there were not four windows to go on in.
[[nodiscard]] inline std::uint64_t run_windowed_cycle(int n) {
  WindowedCycle cycle;
  std::uint64_t sum = 0;
  for (int i = 0; i < n; ++i) {
    begin_counted_call();
    sum += cycle.run();
  }
  begin_counted_call();
  return cycle.has_skipped(4) ? sum | 1U : 0;
}

}  // namespace meridian::bench
