// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "support/cycle_world.hpp"
#include "support/machines.hpp"
#include "support/made_plan.hpp"

namespace meridian::test {

inline const ToolPose kBegin{{0, 0, 0}, {std::sin(0.3), 0, std::cos(0.3)}};
inline const PathLimits kLimits{100, 1500, 30000};

/// A machine in Ready (or Off) and a plan for it that tests write piece by piece.
struct Program {
  explicit Program(State begin = State::kReady, const MachineModel& of = lai_machine())
      : machine(of), plan(machine, *world.port, kBegin) {
    world.in.feedback.position = drives_of(machine, plan.joints());
    if (begin == State::kReady) {
      EXPECT_TRUE(world.enable());
    }
  }

  /// Starts what was planned; the machine has run `seconds` of it.
  void run(double seconds) {
    EXPECT_TRUE(world.run_until(State::kLoaded, 1));
    world.command(Verb::kStart);
    world.run_for(seconds);
  }

  MachineModel machine;
  CycleWorld world{machine};
  MadePlan plan;
};

[[nodiscard]] inline Alarm alarm_of(const CycleWorld& world) {
  return static_cast<Alarm>(world.last(EventCode::kAlarm).a);
}
[[nodiscard]] inline Refusal refusal_of(const CycleWorld& world) {
  return static_cast<Refusal>(world.last(EventCode::kRefused).x);
}

}  // namespace meridian::test
