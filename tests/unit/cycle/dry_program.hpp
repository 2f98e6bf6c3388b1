// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "unit/cycle/program.hpp"

namespace meridian::test {

/// With its home at the begin of the programs of these tests.
[[nodiscard]] inline MachineModel machine_at_begin(MachineModel model) {
  const JointVector at =
      drives_of(model, solve(model, model.tool_length_mm, kBegin, 0, JointVector{}).q);
  for (int i = 0; i < model.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    model.joints[n].home = at[n];
  }
  if (!has_stage(model)) return model;
  model.stage_drives[0].home = at[static_cast<std::size_t>(model.stage.linear_joint)];
  model.stage_drives[1].home = at[static_cast<std::size_t>(model.stage.rotary_joint)];
  return model;
}

/// In Off, with no drives or with some that stand elsewhere and follow what they may.
struct DryRun : Program {
  explicit DryRun(bool has_drives = false, const MachineModel& of = lai_machine())
      : Program(State::kOff, machine_at_begin(of)) {
    world.are_drives_alive = has_drives;
    world.run();
  }
  [[nodiscard]] bool begin() {
    world.command(Verb::kDryRun, 1);
    world.command(Verb::kEnable);
    return world.run_until(State::kReady, 0.1);
  }
  /// Once, by a bridge that says nothing more then.
  void report_emergency() {
    world.in.feedback.emergency_stop = true;
    world.in.feedback.emergency_ns = world.in.now_ns + world.machine.cycle_ns;
  }
  void cut() {
    plan.set_epoch(world.state.epoch);
    plan.cut({30, 0, 0}, kLimits);
    plan.cut({0, 20, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
  }
  [[nodiscard]] std::uint16_t flags() const { return world.records.back().setpoint.flags; }
};

}  // namespace meridian::test
