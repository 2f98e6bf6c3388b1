// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_targets.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/step.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/motion_port.hpp"

namespace meridian::fuzz {

/// The machine without drives or a plan, which hears every verb that the supervisor lets through.
class DryMachine {
 public:
  explicit DryMachine(const MachineModel& model) : model_(model), reader_(port()) {}

  /// False where a stop that was said after it has made it void.
  bool say(const Command& command) {
    const auto& [request, verb, argument] = command;
    in_.has_command = true;
    in_.command = command;
    const bool was_dry = state_.is_dry_run;
    run();
    in_.has_command = false;
    if (is_stop(verb)) stopped_ = std::max(stopped_, request);
    bool is_void = false;
    for (std::size_t i = 0; i < out_.event_count; ++i) {
      const Event& event = out_.events[i];
      is_void = is_void || (event.code == EventCode::kRefused &&
                            static_cast<Refusal>(event.x) == Refusal::kOvertaken);
      if (event.code != EventCode::kAccepted) continue;
      require(!leads_to_motion(verb) || request > stopped_, "done although a stop came after it");
      const bool is_for_dry_run = may_be_dry(verb) && argument != 0;
      require(!is_for_dry_run || was_dry, "accepted for a dry run alone, outside of one");
      require(!may_be_dry(verb) || argument == 0 || argument == 1, "an argument that is none");
    }
    for (int n = 0; n < 3; ++n) run();
    return !is_void;
  }
  /// A hand's order for its joint or the tool, for as long as the tool's way is surveyed.
  void hold(const JogOrder& order) {
    in_.jog = order;
    for (int n = 0; n < 8; ++n) run();
  }
  [[nodiscard]] std::uint16_t epoch() const { return state_.epoch; }
  [[nodiscard]] bool is_jogging() const { return state_.state == State::kJogging; }

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
    require(((flags & kSetpointDry) != 0) == state_.is_dry_run, "a dry run that is not reported");
    for (const double x : out_.record.joints) require(std::isfinite(x), "no place for a joint");
  }

  const MachineModel& model_;
  MotionReader reader_;
  CycleState state_{{}, rate_bounds(model_)};
  CycleInputs in_;
  StepOutput out_;
  std::uint64_t stopped_ = 0;  ///< Command::request of the newest stop
};

}  // namespace meridian::fuzz
