// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/cycle/stop/stop_motion.hpp"
#include "support/machines.hpp"
#include "unit/cycle/program.hpp"

/// A machine in the middle of a cut, and one that a hold stops there.
namespace meridian::test {

/// The bench machine with FaultStop limits `factor` times the others.
inline MachineModel machine_with_faults(double factor) {
  MachineModel machine = bench_machine();
  for (int i = 0; i < machine.joint_count; ++i) {
    JointLimits& limits = machine.joints[static_cast<std::size_t>(i)].limits;
    limits.fault_acceleration = factor * limits.acceleration;
    limits.fault_jerk = factor * limits.jerk;
  }
  return machine;
}

/// In the middle of a cut at 100 mm/s, with one cycle to call functions of.
struct Cutting : Program {
  explicit Cutting(double stop_share = 1, int barriers = 1) {
    plan.stop_share = stop_share;
    plan.cut({200, 0, 0}, kLimits);
    for (int n = 0; n < barriers; ++n)
      plan.barrier(n + 1 < barriers ? TimeKind::kDwell : TimeKind::kEnd);
    run(0.6);
    EXPECT_EQ(world.now(), State::kRunning);
  }
  [[nodiscard]] Cycle cycle() {
    const Feedback& drives = world.in.feedback;
    return {machine, world.state,        world.reader, world.in, world.out,      world.dt(),
            1,       world.state.joints, world.dt(),   drives,   drives.position};
  }
};

/// A hold that began with a tenth of what its piece grants once it is on its way.
struct Holding : Cutting {
  Holding() {
    Cycle c = cycle();
    begin_stop(c, StopKind::kHold);
    stop() = {};
    lay_out_stop(world.state, world.state.on_path, {300, 12'000});
    stop().rate_begin = 1;
    for (int n = 0; n < 30; ++n) EXPECT_TRUE(follow_one_cycle());
  }
  [[nodiscard]] StopInProgress& stop() { return world.state.stop; }
  [[nodiscard]] bool follow_one_cycle() {
    Cycle c = cycle();
    return follow_stop(c);
  }
  /// Grants 3000 mm/s² and 120 000 mm/s³ from now on.
  void grant() {
    // A piece in force is written by the planner alone: of a test it may be written here.
    auto& piece = const_cast<TimePiece&>(*world.reader.piece());
    piece.slow_velocity = 1;
    piece.stop_accel = 3000;
    piece.stop_jerk = 120'000;
  }
};

}  // namespace meridian::test
