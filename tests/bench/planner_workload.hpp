// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "bench/planned_path.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "support/machines.hpp"

namespace meridian::bench {

/// Plans `n` blocks; the port is emptied whenever it is full, as a cycle that needs no time would.
/// Returns the plan time in microseconds, 0 if a block was refused.
[[nodiscard]] inline std::uint64_t run_planner(int n) {
  const MachineModel machine = test::lai_machine();
  RestToRestPlanner planner(machine);
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  planner.begin({}, machine.tool_length_mm, 1);
  double planned_s = 0;
  const auto empty_port = [&] {
    for (const TimePiece* piece = port->times.peek(0); piece != nullptr;
         piece = port->times.peek(0)) {
      planned_s += piece->duration;
      port->times.drop(1);
    }
    port->paths.drop(port->paths.size());
  };
  for (int i = 0; i < n;) {
    switch (planner.plan(block_on_path(static_cast<std::uint64_t>(i)), writer).status) {
      case PlanStatus::kOk:
        ++i;
        break;
      case PlanStatus::kNoRoom:
        empty_port();
        break;
      case PlanStatus::kRefused:
        return 0;
    }
  }
  empty_port();
  return static_cast<std::uint64_t>(planned_s * 1e6);
}

}  // namespace meridian::bench
