// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_targets.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/rt/state_table.hpp"
#include "meridian/rt/step.hpp"

namespace meridian::fuzz {

/// The machine without drives or a plan, which hears every verb that the supervisor lets through.
class DryMachine {
 public:
  explicit DryMachine(const MachineModel& model) : model_(model), reader_(port()) {}

  void say(Verb verb, double argument) {
    in_.has_command = true;
    in_.command = {++request_, verb, argument};
    const bool was_dry = state_.is_dry_run;
    run();
    in_.has_command = false;
    for (std::size_t i = 0; i < out_.event_count; ++i) {
      const Event& event = out_.events[i];
      if (event.code != EventCode::kAccepted) continue;
      const bool is_for_dry_run = may_be_dry(verb) && argument != 0;
      require(!is_for_dry_run || was_dry, "accepted for a dry run alone, outside of one");
      require(!may_be_dry(verb) || argument == 0 || argument == 1, "an argument that is none");
    }
    for (int n = 0; n < 3; ++n) run();
  }

 private:
  static MotionPort& port() {
    static MotionPort empty;  // nothing is ever planned
    return empty;
  }
  void run() {
    in_.now_ns = in_.due_ns = static_cast<std::int64_t>(++in_.cycle) * model_.cycle_ns;
    step(model_, state_, reader_, in_, out_);
    const std::uint16_t flags = out_.record.setpoint.flags;
    require((flags & kSetpointEnabled) == 0, "drives are led that nobody has heard of");
    require(((flags & kSetpointDry) != 0) == state_.is_dry_run, "a dry run that is not told");
    for (const double x : out_.record.joints) require(std::isfinite(x), "no place for a joint");
  }

  const MachineModel& model_;
  MotionReader reader_;
  CycleState state_{{}, rate_bounds(model_)};
  CycleInputs in_;
  StepOutput out_;
  std::uint64_t request_ = 0;
};

}  // namespace meridian::fuzz
