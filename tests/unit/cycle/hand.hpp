// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "support/cycle_world.hpp"
#include "support/machines.hpp"

namespace meridian::test {

/// A machine in Ready without a station, and an operator's hand that sends
/// orders at 50 Hz.
struct Hand {
  explicit Hand(const MachineModel& machine = lai_machine(), const JointVector& at = {},
                std::uint32_t referenced = 0x3F)
      : world(machine, at) {
    world.in.session = 0;
    world.in.feedback.referenced_mask = referenced & all_joints(machine);
    (void)world.enable();
  }

  /// Says `jog`; false where it is refused.
  [[nodiscard]] bool lay_on(int joint) {
    world.command(Verb::kJog, joint);
    epoch = world.state.epoch;
    number = world.request;
    return world.now() == State::kJogging;
  }
  /// Holds `velocity` for so long; the last order comes 20 ms before the end.
  void hold(int joint, double velocity, double seconds) {
    for (double t = 0; t < seconds; t += 0.02) {
      order(joint, velocity);
      world.run_for(0.02);
    }
  }
  /// One order, which the next cycle finds.
  void order(int joint, double velocity) {
    const int index = joint < kMaxJoints ? joint : joint - kMaxJoints;
    world.in.jog = {.sample = ++sample,
                    .epoch = epoch,
                    .is_tool = joint >= kMaxJoints,
                    .joint = static_cast<std::uint8_t>(index),
                    .velocity = velocity,
                    .distance = distance,
                    .tool_length_mm = world.machine.tool_length_mm,
                    .dead_man_s = 0.1,
                    .hand = number,
                    .age_s = age_s};
  }
  [[nodiscard]] Refusal refusal() const {
    return static_cast<Refusal>(world.last(EventCode::kRefused).x);
  }

  CycleWorld world;
  std::uint64_t sample = 0, number = 0;
  std::uint16_t epoch = 1;
  double distance = 0;
  double age_s = 0;  ///< of every order when it comes in
};

}  // namespace meridian::test
